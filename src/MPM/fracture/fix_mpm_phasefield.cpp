/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fracture/fix_mpm_phasefield.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "law/phase_field.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

// length of a phase field from which on a lattice resolves it well [node spacings]
static constexpr double RESOLVED = 2.0;

/** fix ID all mpm/phasefield keyword values ... */
Options MPMPhaseFieldOptions::declare()
{
  using namespace option;
  Options o("fix mpm/phasefield");
  o.add("every", {integer(every, "N", {1, 1000, true}, "steps from one solution to the next")});
  o.add("tolerance",
        {number(tolerance, "T", {0.0, 0.1, false}, "",
                "change of the phase field in an iteration after which it is known")});
  o.add("iterations", {integer(most, "N", {1, 100, true}, "most iterations of a solution")});
  return o;
}

FixMPMPhaseField::FixMPMPhaseField(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/phasefield acts on all points whose material has damage phasefield: use "
               "group all");
  Options declared = declare();
  read_options(lmp, declared, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = 2;
  global_freq = 1;
  extscalar = extvector = 0;
  restart_global = 1;
}

void FixMPMPhaseField::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this, "one acts on all bodies");
}

void FixMPMPhaseField::init_physics(MPMPlan &plan)
{
  fields.clear();
  for (auto *field : plan.fields) {
    auto made = std::make_unique<MPMPhaseField>(lmp, *field);
    const auto present = field->present_materials();
    for (std::size_t k = 0; k < present.size(); k++) {
      const auto *const material = field->materials[k];
      const auto cracks = phase_field_cracks(*material->material);
      if (!cracks || !present[k]) continue;
      check(*field, *material, *cracks);
      made->add(material, *cracks);
    }
    if (made->empty()) continue;
    field->refuse_element_nodes(*this,
                                "in which no crack would grow: give them a fix mpm/material "
                                "without damage phasefield",
                                [](const FixMPMMaterial *of) {
                                  return phase_field_cracks(*of->material).has_value();
                                });
    fields.push_back(std::move(made));
  }
  if (fields.empty() && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/phasefield {} has nothing to do, as no material has damage "
                   "phasefield: give it to what may break",
                   id);
}

void FixMPMPhaseField::check(const MPMField &field, const FixMPMMaterial &material,
                             const PhaseFieldCracks &cracks) const
{
  const double h = field.lattice.h, l = cracks.length;
  if (cracks.varies)
    error->all(FLERR, Error::NOLASTLINE,
               "Length L of damage phasefield of fix mpm/material {} must be the same everywhere: "
               "leave 'random L' or 'vary L' out",
               material.id);
  if (l < h * (1.0 - 1.0e-6))
    error->all(FLERR, Error::NOLASTLINE,
               "Length {} of damage phasefield of fix mpm/material {} is below the node spacing {} "
               "of fix mpm {}, which cannot resolve it: use a length of at least that, or damage "
               "rankine with soften energy",
               l, material.id, h, field.id());
  if (l < RESOLVED * h * (1.0 - 1.0e-6) && comm->me == 0)
    error->warning(FLERR,
                   "Length {} of damage phasefield of fix mpm/material {} is below two node "
                   "spacings {}: the energy of cracks depends on their direction by some percent "
                   "more",
                   l, material.id, h);
  if (cracks.strength == 0.0) return;
  // a = 4 E GC/(pi l sigma^2) must be at least LEAST
  const double most = 4.0 * cracks.modulus * cracks.energy /
      (M_PI * law::PhaseField::LEAST * cracks.strength * cracks.strength);
  if (l > most)
    error->all(FLERR, Error::NOLASTLINE,
               "Length {} of damage phasefield of fix mpm/material {} is too large for a cohesive "
               "crack with its strength and energy: use at most 8 E GC/(3 pi SIGMA^2) = {:.4g}",
               l, material.id, most);
}

void FixMPMPhaseField::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place != MPMPlan::BEFORE_POINTS_TO_NODES || fields.empty()) return;
  plan.together("phase field",
                {Data::POSITION, Data::DEFORMATION, Data::HISTORY, Data::MASS, Data::NODES,
                 Data::BLOCKS, Data::OWN},
                {Data::HISTORY, Data::OWN}, [this] {
                  if (++waited < every) return;
                  waited = 0;
                  for (const auto &of : fields) solve(*of);
                });
}

void FixMPMPhaseField::solve(MPMPhaseField &of)
{
  const std::string failure = of.solve(*this);
  if (!failure.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/phasefield {} found no solution at step {}: {}. Has the stress of points "
               "become too large? Use a smaller time step",
               id, update->ntimestep, failure);
}

/** Share of the points with a phase field that took part in the last solution. */
double FixMPMPhaseField::compute_scalar()
{
  double share = 0.0;
  for (const auto &of : fields) share = std::max(share, of->report.share);
  return share;
}

/** Iterations, and products with the matrix, of the last solution. */
double FixMPMPhaseField::compute_vector(int k)
{
  int most = 0;
  for (const auto &of : fields)
    most = std::max(most, k == 0 ? of->report.newton : of->report.products);
  return most;
}

double FixMPMPhaseField::memory_usage()
{
  double bytes = 0.0;
  for (const auto &of : fields) bytes += of->memory_usage();
  return bytes;
}

void FixMPMPhaseField::write_restart(FILE *fp)
{
  if (comm->me == 0) write_state(fp, &waited, sizeof(waited));
}

void FixMPMPhaseField::restart(char *buf)
{
  waited = *(const int *) read_state(lmp, id, buf, sizeof(waited));
}
