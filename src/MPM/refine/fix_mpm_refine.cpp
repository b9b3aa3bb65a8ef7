/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "refine/fix_mpm_refine.h"

#include "base/mpm_options.h"
#include "comm.h"
#include "contact/fix_mpm_contact.h"
#include "contact/fix_mpm_rigid.h"
#include "contact/pair_mpm_penalty.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "force.h"
#include "implicit/fix_mpm_relax.h"
#include "loads/fix_mpm_dashpot.h"
#include "modify.h"
#include "refine/mpm_two_scale.h"
#include "step/fix_mpm.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

/** fix ID all mpm/refine COARSE FINE ... */
FixMPMRefine::FixMPMRefine(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/refine acts on nodes, which have no group: use group all; the fields whose "
               "points are one body are named");
  require_arguments(lmp, "fix mpm/refine", narg, 3, {"coarse-ID", "fine-ID"});
  for (int i = 3; i < narg; i++) {
    const std::string name = arg[i];
    if (std::find(ids.begin(), ids.end(), name) != ids.end())
      error->all(FLERR, i, "Fix mpm/refine {}: the field {} is named twice", id, name);
    ids.push_back(name);
  }
  vector_flag = 1;
  size_vector = 2 * ((int) ids.size() - 1);
  global_freq = 1;
  extvector = 1;
}

FixMPMRefine::~FixMPMRefine() = default;

/** Missing fields are found here; with them, they call init_action(). */
void FixMPMRefine::init()
{
  for (const auto &name : ids)
    if (!MPMField::find(lmp, name))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/refine {}: {} is not the ID of a fix mpm: define one fix mpm for the "
                 "points on each lattice",
                 id, name);
}

void FixMPMRefine::init_action()
{
  FixMPMRefine::init();
  pairs.clear();
  fields.clear();
  for (const auto &name : ids) fields.push_back(MPMField::find(lmp, name));
  for (auto *other : find_fixes<FixMPMRefine>(lmp))
    if (other != this)
      for (const auto &name : ids)
        if (std::find(other->ids.begin(), other->ids.end(), name) != other->ids.end())
          error->all(FLERR, Error::NOLASTLINE,
                     "Fix mpm/refine {} and {} have the field {} in common: name all fields of a "
                     "body in one of them, from the coarsest lattice to the finest",
                     id, other->id, name);
  for (std::size_t k = 0; k + 1 < fields.size(); k++) {
    check(*fields[k], *fields[k + 1]);
    pairs.push_back(std::make_unique<MPMTwoScale>(lmp, *fields[k], *fields[k + 1],
                                                  k ? pairs[k - 1].get() : nullptr));
  }

  // records of nodes are added
  const bool keep = std::any_of(fields.begin(), fields.end(), [&](const auto *field) {
    return field->keeps_old_velocities() ||
        adds_change(field->options.transfer) != adds_change(fields[0]->options.transfer);
  });
  for (auto *field : fields)
    if (keep) field->keep_old_velocities();
}

void FixMPMRefine::check(MPMField &coarse, MPMField &fine) const
{
  const auto &oc = coarse.options;
  for (auto *field : {&coarse, &fine}) {
    const auto &o = field->options;
    refuse_field(
        lmp, *this, *field,
        {{o.shape != LINEAR && o.shape != QUADRATIC && o.shape != CUBIC, "this shape",
          "its functions are no sums of functions of half the width: use shape linear, quadratic, "
          "or cubic"},
         {!is_affine(o.transfer) || o.polypic, "this transfer",
          "points must have the gradient of the velocity for nodes at the rim of a lattice: use "
          "transfer apic, aflip, or tpic"},
         {o.series != MPMFieldOptions::LUMPED, "transfer xpic and fmpm",
          "use apic, aflip, or tpic"},
         {o.stress_before(), "scheme usf and usavg", "use usl or musl"},
         {o.most_distorted > 0.0, "a reference that is renewed",
          "its lattices would part: use frame total without, or frame updated"},
         {o.modified_edges, "edges modified", "use edges plain"},
         {o.smooths_volumes(), "smooth", "leave it out"},
         {o.has_light_nodes(), "light", "leave it out"}});
  }
  const auto &of = fine.options;
  const auto refuse = [&](bool broken, const std::string &what) {
    if (broken)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/refine {}: fix mpm {} and {} must have {}", id,
                 coarse.id(), fine.id(), what);
  };
  refuse(oc.shape != of.shape, "the same shape function");
  refuse(oc.total != of.total, "the same frame");
  refuse(std::fabs(2.0 * fine.lattice.h - coarse.lattice.h) > 1.0e-10 * coarse.lattice.h,
         fmt::format("node spacings in the ratio 2: use {:.16g} for {}, or name a field between "
                     "them",
                     0.5 * coarse.lattice.h, fine.id()));
  if (!MPMTwoScale::fits(coarse, fine)) {
    std::string where;
    for (int d = 0; d < coarse.lattice.dim; d++)
      where += fmt::format(" {:.16g}", MPMTwoScale::fine_origin(coarse, d));
    refuse(true,
           fmt::format("lattices that fit, which those of this shape do when fix mpm {} has "
                       "origin{}",
                       fine.id(), where));
  }
}

/** What to do in place of a physics that nodes at the rim do not have. */
static std::string in_place_of(const std::string &style)
{
  if (style == "mpm/implicit")
    return "use explicit steps, with fix mpm/relax for a body at rest, or one fix mpm for all of "
           "the body";
  if (style == "mpm/pml") return "use fix mpm/dashpot, or one fix mpm for all of the body";
  return "use one fix mpm for all of the body, with the node spacing that its finest part needs";
}

/** What acts on nodes acts on those of all fields, and tied ones follow; what exchanges something
 *  between places would miss those. */
void FixMPMRefine::check_others(const MPMPlan &plan) const
{
  for (auto *action : plan.actions) {
    auto *ifix = dynamic_cast<Fix *>(action);
    const auto *contact = dynamic_cast<FixMPMContact *>(action);
    if (contact) check_contact(plan, *contact);
    if (!contact && !dynamic_cast<FixMPMRefine *>(action) &&
        !dynamic_cast<FixMPMBoundary *>(action) && !dynamic_cast<FixMPMRigid *>(action) &&
        !dynamic_cast<FixMPMDashpot *>(action))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/refine {} does not go with fix {} {}, which would miss what nodes at the "
                 "rim of a lattice have: {}",
                 id, ifix->style, ifix->id, in_place_of(ifix->style));
  }
  auto *const penalty = dynamic_cast<PairMPMPenalty *>(force->pair_match("mpm/penalty", 0));
  for (const auto &a : ids)
    for (const auto &b : ids)
      if (penalty && penalty->couples(a, b))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/refine {}: the fields {} and {} are one body, which pair style "
                   "mpm/penalty takes for two: give their types a pair_coeff with modulus 0",
                   id, a, b);
  for (auto *physics : plan.physics) {
    auto *ifix = dynamic_cast<Fix *>(physics);
    if (!dynamic_cast<MPMLoad *>(physics) && !dynamic_cast<FixMPMRefine *>(physics) &&
        !dynamic_cast<FixMPMRelax *>(physics) && !dynamic_cast<FixMPMDashpot *>(physics) &&
        !dynamic_cast<MPMHeatSink *>(physics))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/refine {} does not go with fix {} {}, whose values at nodes would not be "
                 "continuous from one lattice to the other: {}",
                 id, ifix->style, ifix->id, in_place_of(ifix->style));
  }
}

/** Contact is at nodes, on each lattice between the fields that have it. It is seen everywhere if
 *  another body has a field on each lattice from the coarsest of this one to its own finest: what
 *  is finer in this one is tied where the other one is. */
void FixMPMRefine::check_contact(const MPMPlan &plan, const FixMPMContact &contact) const
{
  for (const auto &a : ids)
    for (const auto &b : ids)
      if (contact.couples(a, b))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/refine {}: the fields {} and {} are one body, which fix mpm/contact {} "
                   "takes for two: leave one of them out there",
                   id, a, b, contact.id);
  for (int mine = 0; mine < (int) ids.size(); mine++)
    for (const auto *field : plan.fields)
      if (contact.couples(ids[mine], field->id()))
        check_contact_with(plan, contact, mine, field->id());
}

void FixMPMRefine::check_contact_with(const MPMPlan &plan, const FixMPMContact &contact, int mine,
                                      const std::string &theirs) const
{
  std::vector<std::string> body = {theirs};
  for (const auto *other : find_fixes<FixMPMRefine>(lmp))
    if (other->has(theirs)) body = other->ids;
  const auto touching = [&](const std::string &a, const std::string &b) {
    const FixMPMContact *found = nullptr;
    for (auto *action : plan.actions) {
      const auto *one = dynamic_cast<FixMPMContact *>(action);
      if (one && one->couples(a, b)) found = one;
    }
    return found;
  };
  double most = 0.0;    // node spacing of the body
  for (const auto &name : body) {
    const double h = MPMField::find(lmp, name)->lattice.h;
    most = std::max(most, h);
    for (const auto *field : fields) {
      if (std::fabs(field->lattice.h - h) > 1.0e-10 * h) continue;
      const auto *other = touching(field->id(), name);
      if (!other)
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/refine {}: {} and {} touch by fix mpm/contact {}, but {} and {}, which "
            "are of the same bodies, do not: add fix mpm/contact {} {} with the same options",
            id, ids[mine], theirs, contact.id, field->id(), name, field->id(), name);
      if (!other->has_law_of(contact))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/refine {}: fix mpm/contact {} and {} are between the same two bodies: "
                   "give both the same law, normal, and gap",
                   id, contact.id, other->id);
    }
  }
  // told once, for the coarsest lattice that both have
  if (fields[0]->lattice.h > (1.0 + 1.0e-10) * most && comm->me == 0 &&
      fields[mine]->lattice.h >= (1.0 - 1.0e-10) * most)
    error->warning(FLERR,
                   "Fix mpm/refine {}: no field of the body of {} is on the lattice of {}, so that "
                   "fix mpm/contact {} does not see it where it meets points of {}, or the rim to "
                   "these: keep it away from there, or make a fix mpm on this lattice, without "
                   "points if need be, part of that body by fix mpm/refine",
                   id, theirs, ids[0], contact.id, ids[0]);
}

/** All that touch this body, or what touches it: where several bodies meet, all must have the same
 *  functions. */
void FixMPMRefine::find_neighbors(const MPMPlan &plan)
{
  neighbors.clear();
  for (int k = 0; k + 1 < (int) fields.size(); k++) {
    std::vector<MPMField *> found = {fields[k]};
    for (std::size_t n = 0; n < found.size(); n++)
      for (auto *action : plan.actions) {
        const auto *contact = dynamic_cast<FixMPMContact *>(action);
        for (auto *field : plan.fields)
          if (contact && contact->couples(found[n]->id(), field->id()) &&
              !std::count(found.begin(), found.end(), field))
            found.push_back(field);
      }
    for (std::size_t n = 1; n < found.size(); n++) {
      neighbors.push_back({found[n], k, {}});
      pairs[k]->add_neighbor(*found[n]);
    }
  }
  reaches.resize(fields.size());
}

bool FixMPMRefine::decides_contact(const MPMField &field) const
{
  const auto contacts = find_fixes<FixMPMContact>(lmp);
  return has(field.id()) && std::any_of(contacts.begin(), contacts.end(), [this](const auto *c) {
           return std::any_of(ids.begin(), ids.end(), [c](const auto &name) {
             return c->touches(name);
           });
         });
}

void FixMPMRefine::init_physics(MPMPlan &plan)
{
  check_others(plan);
  for (const auto *field : fields) {
    const auto *const fix = dynamic_cast<const FixMPM *>(modify->get_fix_by_id(field->id()));
    if (fix && fix->rests_dry && field->counts().steps == 0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/refine {}: points of fix mpm {} have the stress of mpm_geostatic, which "
                 "does not know the weight of the other lattices: let the body come to rest under "
                 "its weight with fix mpm/relax in its place, or use one lattice",
                 id, field->id());
  }
  find_neighbors(plan);
}

void FixMPMRefine::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place == MPMPlan::BEFORE_POINTS_TO_NODES)
    plan.together("tied nodes", {Data::POSITION, Data::BLOCKS, Data::OWN}, {Data::OWN}, [this]() {
      find_tied();
    });
  if (place == MPMPlan::AFTER_POINTS_TO_NODES)
    plan.together(
        "tied nodes", {Data::NODES, Data::BLOCKS, Data::OWN}, {Data::NODES, Data::OWN}, [this]() {
          for (int k = (int) pairs.size() - 1; k >= 0; k--)
            pairs[k]->to_parents(k + 1 < (int) pairs.size() ? pairs[k + 1].get() : nullptr);
        });
}

void FixMPMRefine::act(double, Stage)
{
  for (auto &pair : pairs) pair->from_parents();
}

void FixMPMRefine::find_tied()
{
  for (auto &pair : pairs) pair->find_tied();
  if (warned) return;
  warned = true;
  for (auto &pair : pairs) {
    // a field without points is there for contact with others
    bigint all[4],
        mine[4] = {pair->count.tied, pair->count.free, (bigint) pair->coarse.map->runs.size(),
                   (bigint) pair->fine.map->runs.size()};
    MPI_Allreduce(mine, all, 4, MPI_LMP_BIGINT, MPI_SUM, world);
    static constexpr double SOME = 0.1;
    if (all[0] && all[1] && pair->share_of_thin(fields) > SOME && comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/refine {}: between the surface of the body and points of fix mpm {} "
                     "those of {} fill one coarse cell: loads and walls there have errors of 4 to "
                     "35 %: let them fill two or more",
                     id, pair->coarse.id(), pair->fine.id());
    if (comm->me || !all[2] || !all[3] || (all[0] && all[1])) continue;
    if (all[0])
      error->warning(FLERR,
                     "Fix mpm/refine {}: no node of fix mpm {} is free, as points of {} are in all "
                     "cells that its points reach: it has no effect; keep the points of the fields "
                     "in regions of their own, of several cells",
                     id, pair->fine.id(), pair->coarse.id());
    else
      error->warning(FLERR,
                     "Fix mpm/refine {}: no node of fix mpm {} is tied: its points and those of {} "
                     "do not meet",
                     id, pair->fine.id(), pair->coarse.id());
  }
}

/** Laws of damage spend the energy of a crack that is one cell of their own lattice wide. Next to
 *  the rim functions are those of two lattices, and cracks are as wide as the larger cells. Points
 *  that have lost half of their stress and see nodes that are tied, or parents of these. */
bigint FixMPMRefine::cracked_at_rim(const MPMTwoScale &pair) const
{
  static constexpr double CRACKED = 0.5;
  std::vector<double> tied(pair.fine.grid.nnodes(), 0.0), parents(pair.coarse.grid.nnodes(), 0.0);
  for (std::size_t k = 0; k < tied.size(); k++) tied[k] = pair.is_tied((int64_t) k);
  const auto rim = tied;
  pair.sums_to_parents(tied, parents);
  pair.coarse.nodes.sum(parents.data(), 1, 0, 1);
  bigint mine = 0, all;
  for (const auto &[field, near] : {std::pair(&pair.fine, &rim), {&pair.coarse, &parents}})
    for (const auto &run : field->map->runs) {
      const int column = run.material ? run.material->damage : -1;
      if (column < 0) continue;
      for (int i = run.first; i < run.last; i++) {
        if (run.material->history[i][column] < CRACKED) continue;
        bool sees = false;
        MPMStencil(*field).visit(field->grid.blocks[run.slot], i, [&, &rim = *near](auto &node) {
          sees = sees || (node.weight > 0.0 && rim[node.number] > 0.0);
        });
        mine += sees;
      }
    }
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  return all;
}

void FixMPMRefine::post_run()
{
  const auto materials = find_fixes<FixMPMMaterial>(lmp);
  const bool can_crack = std::any_of(materials.begin(), materials.end(), [](const auto *m) {
    return m->damage >= 0;
  });
  if (!can_crack || !warned || told_of_cracks) return;    // warned: there was a step
  for (const auto &pair : pairs) {
    const bigint cracked = cracked_at_rim(*pair);
    if (!cracked || told_of_cracks) continue;
    told_of_cracks = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/refine {}: {} points at the rim between fix mpm {} and {} have lost "
                     "half of their stress or more by damage: cracks there spend 0.9 to 1.7 times "
                     "the energy that they spend elsewhere: keep rims three coarse cells away from "
                     "where the material fails",
                     id, cracked, pair->coarse.id(), pair->fine.id());
  }
}

/** Each field has nodes for the sake of the finer ones: all are renewed together. */
bool FixMPMRefine::is_stale() const
{
  return std::any_of(fields.begin(), fields.end(),
                     [](const auto *field) {
                       return !field->map->valid;
                     }) ||
      std::any_of(neighbors.begin(), neighbors.end(), [](const auto &neighbor) {
           return !neighbor.field->map->valid;
         });
}

void FixMPMRefine::couple_topology()
{
  if (!is_stale()) return;
  for (auto *field : fields) field->map->valid = false;
  for (auto &neighbor : neighbors) neighbor.field->map->valid = false;
}

void FixMPMRefine::blocks_found()
{
  if (!neighbors.empty() && is_stale()) {
    for (int k = 0; k + 1 < (int) fields.size(); k++) {
      extend_for_finer(*fields[k]);
      reaches[k].find(fields[k]->grid, world);
    }
    for (auto &neighbor : neighbors) neighbor.reach.find(neighbor.field->grid, world);
  }
  const bool keep = std::any_of(fields.begin(), fields.end(), [](const auto *field) {
    return field->keeps_old_velocities_now();
  });
  for (auto *field : fields) field->keep_old_velocities_now(keep);
}

int FixMPMRefine::level(const std::string &name) const
{
  return (int) (std::find(ids.begin(), ids.end(), name) - ids.begin());
}

int FixMPMRefine::level(const MPMField &field) const
{
  return (int) (std::find(fields.begin(), fields.end(), &field) - fields.begin());
}

std::vector<MPMField *> FixMPMRefine::finer_than(const std::string &name) const
{
  std::vector<MPMField *> list;
  for (int k = level(name) + 1; k < (int) ids.size(); k++)
    list.push_back(MPMField::find(lmp, ids[k]));
  return list;
}

void FixMPMRefine::extend_for_finer(const MPMField &field) const
{
  const int mine = level(field);
  for (int finer = mine + 1; finer < (int) fields.size(); finer++)
    pairs[mine]->extend_coarse(*fields[finer], finer - mine);
}

void FixMPMRefine::extend_topology(MPMField &field)
{
  extend_for_finer(field);
  for (const auto &neighbor : neighbors)    // where cells with its points are looked up
    if (neighbor.field == &field)
      neighbor.reach.activate_those_of(reaches[neighbor.level], field.grid);
}

void FixMPMRefine::topology_changed(MPMField &field)
{
  if (level(field) == (int) fields.size()) return;
  for (auto &pair : pairs) pair->topology_changed();
}

/** For each pair of fields: nodes of the finer one that are tied, and those that are free. */
double FixMPMRefine::compute_vector(int n)
{
  double mine = 0.0, all;
  if (n / 2 < (int) pairs.size()) {
    const auto &count = pairs[n / 2]->count;
    mine = (double) (n % 2 ? count.free : count.tied);
  }
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMRefine::memory_usage()
{
  double bytes = 0.0;
  for (const auto &pair : pairs) bytes += pair->memory_usage();
  return bytes;
}
