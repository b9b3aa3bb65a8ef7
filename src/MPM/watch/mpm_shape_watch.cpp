/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_shape_watch.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "material/material.h"
#include "material/material_point.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int PAIRS[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

MPMShapeWatch::Shapes MPMShapeWatch::find() const
{
  Shapes mine;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double x[3];
    domain->unmap(atom->x[i], atom->image[i], x);
    for (int d = 0; d < 3; d++) x[d] -= 0.5 * (domain->boxlo[d] + domain->boxhi[d]);
    auto &sums = mine[atom->mask[i]];
    sums[COUNT] += 1.0;
    sums[TAGS] += (double) atom->tag[i];
    for (int d = 0; d < 3; d++) sums[PLACE + d] += x[d];
    for (int d = 0; d < 3; d++) sums[TAGGED + d] += (double) atom->tag[i] * x[d];
    for (int p = 0; p < 6; p++) sums[SQUARE + p] += x[PAIRS[p][0]] * x[PAIRS[p][1]];
  }

  // the same groups in the same order on all ranks
  std::vector<int> bits;
  for (const auto &[mask, sums] : mine) bits.push_back(mask);
  const auto of_all = gather_on_all(bits, world);
  Shapes all;
  for (const int mask : std::set<int>(of_all.begin(), of_all.end()))
    MPI_Allreduce(mine[mask].data(), all[mask].data(), NSUMS, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

// displacements of this share of a body are told, and not round-off of sums
static constexpr double SHARE = 1.0e-9, ROUND_OFF = 1.0e-13;

/** Of all second moments about the center, the sum and the squares do not change in turns. Of the
 *  first moments with tags as weights, which also see turns of bodies that look the same after
 *  them, this is the length. */
MPMShapeWatch::Motion MPMShapeWatch::compare(const Sums &then, const Sums &now)
{
  double trace[2] = {}, square[2] = {}, length[2] = {}, far = 0.0, turned = 0.0, shifted = 0.0;
  const auto moment = [](const Sums &s, int p) {
    const auto [a, b] = PAIRS[p];
    return s[SQUARE + p] - s[PLACE + a] * s[PLACE + b] / s[COUNT];
  };
  const auto tagged = [](const Sums &s, int d) {
    return s[TAGGED + d] - s[TAGS] * s[PLACE + d] / s[COUNT];
  };
  for (const auto *s : {&then, &now}) {
    const int k = (s == &now);
    for (int p = 0; p < 6; p++) {
      const bool diagonal = p < 3;
      if (diagonal) trace[k] += moment(*s, p);
      square[k] += (diagonal ? 1.0 : 2.0) * moment(*s, p) * moment(*s, p);
      if (diagonal) far += (*s)[SQUARE + p];
    }
    length[k] = std::hypot(tagged(*s, 0), tagged(*s, 1), tagged(*s, 2));
  }
  const double least = SHARE * trace[0] + ROUND_OFF * far;
  if (fabs(trace[1] - trace[0]) > least || fabs(sqrt(square[1]) - sqrt(square[0])) > least)
    return STRAINED;

  for (int p = 0; p < 6; p++) turned = std::max(turned, fabs(moment(now, p) - moment(then, p)));
  if (turned > least) return TURNED;
  const double little = SHARE * length[0] + ROUND_OFF * then[TAGS] * sqrt(far / then[COUNT]);
  for (int d = 0; d < 3; d++) shifted = std::max(shifted, fabs(tagged(now, d) - tagged(then, d)));
  const bool has_same_tags = fabs(length[1] - length[0]) <= little;
  return has_same_tags && shifted > little ? TURNED : RIGID;
}

/** Has a solid point that is in exactly these groups a strain, or a stress that has a direction?
 *  Collective. */
bool MPMShapeWatch::is_strained(int mask) const
{
  const double scale = force->mvv2e * force->nktv2p;    // of density velocity^2, in pressure units
  const MPMPoints &points = *MPMPoints::get(atom);
  std::map<const FixMPMMaterial *, double> stiffness;
  for (const auto *material : field.materials) {
    if (!material->material->is_solid()) continue;
    const double c = MaterialPoint(*material->material).wave_speed();
    stiffness[material] = scale * material->material->density() * c * c;
  }
  int some = 0, some_all;
  for (int i = 0; i < atom->nlocal && !some; i++) {
    if (!field.is_point(i) || atom->mask[i] != mask) continue;
    const auto found = stiffness.find(field.material_of(i));
    if (found == stiffness.end()) continue;
    const double *const tau = points.tau[i], mean = (tau[0] + tau[1] + tau[2]) / 3.0;
    for (int k = 0; k < 9; k++) some |= fabs(points.F[i][k] - (k % 4 == 0)) > SHARE;
    for (int c = 0; c < 6; c++) some |= fabs(tau[c] - (c < 3 ? mean : 0.0)) > SHARE * found->second;
  }
  MPI_Allreduce(&some, &some_all, 1, MPI_INT, MPI_MAX, world);
  return some_all;
}

/** Points that came, left, or changed their groups are no reason: then nothing is known. */
void MPMShapeWatch::check()
{
  if (before.empty() || warned) return;
  const Shapes now = find();
  for (const auto &[mask, then] : before) {
    const auto found = now.find(mask);
    if (found == now.end()) continue;
    const auto &sums = found->second;
    if (sums[COUNT] != then[COUNT] || sums[TAGS] != then[TAGS]) continue;
    const Motion motion = compare(then, sums);
    // with frame total, positions of the reference have not turned either
    if (motion == RIGID || (motion == TURNED && !field.options.total && !is_strained(mask)))
      continue;
    warned = true;
    if (comm->me) return;
    if (motion == TURNED)
      error->warning(FLERR,
                     "Fix mpm {}: a command has turned {:.0f} points since the last run, and their "
                     "deformation and stress are as they were: turn bodies by their velocity, or "
                     "before the first run",
                     field.id(), sums[COUNT]);
    else
      error->warning(
          FLERR,
          "Fix mpm {}: a command has moved {:.0f} points relative to each other since "
          "the last run, and their deformation is as it was, so that no stress follows "
          "from it: strain bodies by walls, by velocity, or by fix mpm/deform, and place "
          "points before the first run",
          field.id(), sums[COUNT]);
    return;
  }
}
