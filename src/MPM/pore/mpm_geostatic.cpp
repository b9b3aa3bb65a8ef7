/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   In level ground the total vertical stress s(y) is in equilibrium on the nodes if

     sum_p V_p s_p psi_k'(y_p) = - sum_p m_p g psi_k(y_p)

   for all functions psi_k of the height that the velocity of nodes can have: those of planes of
   nodes, of which the three lowest move in proportion to their distance from the floor, as walls
   want it (mpm_line_constraint.cpp). Psi' are what forces have as gradients. The stress rho g (y -
   top) is not quite a solution: sums over points are not integrals where the functions are cut by
   the surface, and forces of 1/64 to 1/32 of the weight of a cell are left over. With

     s_p = rho g y_p + sum_k lambda_k psi_k'(y_p)

   the equations have a matrix with a band, positive definite, whose solution is the least change of
   the stress, to round-off. It is that of layers with several densities, too. In the ground below
   the first cells it is the weight above the point.

   Between planes of nodes the stress of the uppermost points follows from the equation of the
   uppermost nodes alone. It is smaller than that of their depth, by up to 0.204 of the weight of a
   cell.
------------------------------------------------------------------------- */

#include "pore/mpm_geostatic.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"
#include "field/mpm_point_batches.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "material/material.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int LOWEST = 3;    // planes of nodes that move with the distance from the floor
static constexpr double SAME = 1.0e-6;

MPMGeostatic::MPMGeostatic(LAMMPS *lmp, MPMField &field, const double *gravity,
                           const std::string &who) :
    Pointers(lmp),
    field(field), who(who)
{
  find_ground(gravity);
  check_level();
  warn_of_gap();
}

/** Nodes of finite elements have no stress, and are a load on the ground. */
bool MPMGeostatic::is_ground(int i) const
{
  return field.is_point(i) && !field.is_element_node(i);
}

double MPMGeostatic::height(int i) const
{
  return where.up * atom->x[i][where.axis];
}

void MPMGeostatic::find_ground(const double *gravity)
{
  const auto &lattice = field.lattice;
  double size = 0.0;
  for (int d = 0; d < 3; d++) size = std::max(size, fabs(gravity[d]));
  int naxis = 0;
  for (int d = 0; d < 3; d++)
    if (size > 0.0 && fabs(gravity[d]) > SAME * size) {
      where.axis = d;
      naxis++;
    }
  if (naxis != 1 || where.axis >= lattice.dim)
    error->all(
        FLERR, Error::NOLASTLINE,
        "{} needs a weight along an axis of the box: use a fix gravity of constant magnitude "
        "along x, y, or z",
        who);
  if (domain->periodicity[where.axis])
    error->all(FLERR, Error::NOLASTLINE,
               "{} needs a face of the box on which the soil stands: use boundary f along gravity",
               who);
  where.weight = size;
  where.up = gravity[where.axis] > 0.0 ? -1.0 : 1.0;
  where.floor = where.up > 0.0 ? domain->boxlo[where.axis] : -domain->boxhi[where.axis];
  floor = (where.floor - where.up * lattice.origin[where.axis]) / lattice.h;
  const double reach = 0.5 * (stencil_order(field.options.shape) + 1);
  first = (int) std::floor(floor - reach + SAME) + 1;
  if (field.options.shape == CUBIC && fabs(floor - std::round(floor)) > SAME)
    error->all(
        FLERR, Error::NOLASTLINE,
        "{} with shape cubic needs a floor in a plane of nodes: use origin of fix mpm, or shape "
        "quadratic",
        who);

  double mine[2] = {0.0, -1.0e300}, all[2];    // points, surface
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_ground(i)) continue;
    const double V = atom->vfrac[i] * field.points->jacobian(i);
    mine[0] = 1.0;
    mine[1] = std::max(mine[1], height(i) + 0.5 * pow(V, 1.0 / lattice.dim));
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
  if (!(all[0] > 0.0)) error->all(FLERR, Error::NOLASTLINE, "{} needs points at first", who);
  where.top = all[1];
  nfunctions = (int) std::ceil((where.top - where.floor) / lattice.h + floor + reach) - first + 1;
}

/** The volume over the area of the widest plane is the height of level ground. */
void MPMGeostatic::check_level()
{
  const auto &lattice = field.lattice;
  const MPMStencil stencil(field);
  std::vector<double> mine(nfunctions + LOWEST + BAND, 0.0), all(mine.size());
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_ground(i)) continue;
    int plane;
    double w[4];
    const double t = (height(i) - where.up * lattice.origin[where.axis]) / lattice.h;
    const int n = stencil.weights(t, plane, w);
    for (int k = 0; k < n; k++) {
      const int at = std::clamp(plane + k - first, 0, (int) mine.size() - 1);
      mine[at] += w[k] * atom->vfrac[i] * field.points->jacobian(i);
    }
  }
  MPI_Allreduce(mine.data(), all.data(), (int) all.size(), MPI_DOUBLE, MPI_SUM, world);
  double volume = 0.0;
  for (const double V : all) volume += V;
  const double area = *std::max_element(all.begin(), all.end()) / lattice.h;
  const double high = where.top - where.floor, low = volume / area;
  if (fabs(high - low) > 0.25 * lattice.h + 0.01 * high)
    error->all(
        FLERR, Error::NOLASTLINE,
        "{} needs level ground that stands on a face of the box: the surface is at most {:.6g} "
        "above that face, but in the mean {:.6g}; let other ground come to rest under its weight",
        who, high, low);
}

/** Nodes see where the rows of points end: with these off the face, forces on nodes are balanced by
 *  a stress next to it that is not the weight above, by a share that does not become less with the
 *  spacing. */
void MPMGeostatic::warn_of_gap() const
{
  constexpr double CLOSE = 0.02, ROW = 0.1;    // in node spacings
  const double h = field.lattice.h;
  double mine = 1.0e300, lowest, next;
  for (int i = 0; i < atom->nlocal; i++)
    if (is_ground(i)) mine = std::min(mine, height(i));
  MPI_Allreduce(&mine, &lowest, 1, MPI_DOUBLE, MPI_MIN, world);
  mine = 1.0e300;
  for (int i = 0; i < atom->nlocal; i++)
    if (is_ground(i) && height(i) > lowest + 1.0e-3 * h) mine = std::min(mine, height(i));
  MPI_Allreduce(&mine, &next, 1, MPI_DOUBLE, MPI_MIN, world);
  if (next > where.top || next - lowest < ROW * h) return;    // points are not in rows
  const double gap = (lowest - 0.5 * (next - lowest) - where.floor) / h;
  if (comm->me == 0 && fabs(gap) > CLOSE)
    error->warning(
        FLERR,
        "{}: the ground ends {:.2g} node spacings {} the face of the box on which it stands, where "
        "its stress is not the weight above then, by 10 to 40 % with 0.1 to 0.2: make the points "
        "before fix mpm, or give this an origin with which they end at the face",
        who, fabs(gap), gap > 0.0 ? "above" : "below");
}

int MPMGeostatic::planes(const MPMField &of, int i, Part list[BAND]) const
{
  const auto &lattice = field.lattice;
  const MPMStencil stencil(of);
  int plane;
  double w[4], slope[4];
  const double t = (height(i) - where.up * lattice.origin[where.axis]) / lattice.h;
  const int n = stencil.weights(t, plane, w, slope);
  const auto &o = of.options;
  if (is_mls(o.shape, o.transfer) && !o.strains_by_gradient())
    for (int j = 0; j < n; j++)    // moving least squares take these in the place of gradients
      slope[j] = shape_constants[o.shape].inv_moment * w[j] * (plane + j - t);
  for (int j = 0; j < n; j++) list[j] = {plane + j - first, w[j], slope[j]};
  return n;
}

int MPMGeostatic::function_of(int plane, double &value) const
{
  const int k = std::max(0, plane - (LOWEST - 1));
  value = k == 0 ? plane + first - floor : 1.0;
  return k;
}

int MPMGeostatic::parts(int i, Part list[BAND]) const
{
  Part all[BAND];
  const int n = planes(field, i, all);
  int count = 0;
  for (int j = 0; j < n; j++) {
    double size;
    const int k = function_of(all[j].k, size);
    if (count && list[count - 1].k == k) {
      list[count - 1].value += size * all[j].value;
      list[count - 1].slope += size * all[j].slope;
    } else {
      list[count++] = {k, size * all[j].value, size * all[j].slope};
    }
  }
  return count;
}

/** By Cholesky's decomposition of the band; functions that no point sees have the factor zero. */
std::vector<double> MPMGeostatic::solve(std::vector<double> &a, std::vector<double> x) const
{
  constexpr double NOTHING = 1.0e-13;
  const int n = nfunctions;
  double most = 0.0;
  for (int k = 0; k < n; k++) most = std::max(most, a[BAND * k]);
  for (int k = 0; k < n; k++) {    // a[BAND*k + m]: row k, column k - m
    for (int m = std::min(k, BAND - 1); m >= 0; m--) {
      double &l = a[BAND * k + m];
      const int j = k - m;
      for (int q = std::max(0, k - BAND + 1); q < j; q++)
        l -= a[BAND * k + k - q] * a[BAND * j + j - q];
      if (m) {
        l = a[BAND * j] > 0.0 ? l / a[BAND * j] : 0.0;
      } else {
        l = l > NOTHING * most ? sqrt(l) : 0.0;
      }
    }
  }
  for (int k = 0; k < n; k++) {
    for (int m = 1; m < BAND && m <= k; m++) x[k] -= a[BAND * k + m] * x[k - m];
    x[k] = a[BAND * k] > 0.0 ? x[k] / a[BAND * k] : 0.0;
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int m = 1; m < BAND && k + m < n; m++) x[k] -= a[BAND * (k + m) + m] * x[k + m];
    x[k] = a[BAND * k] > 0.0 ? x[k] / a[BAND * k] : 0.0;
  }
  return x;
}

void MPMGeostatic::set_stress(double K0, const std::function<double(int)> &pressure,
                              const std::vector<double> &carried)
{
  const double h = field.lattice.h, g = where.weight * force->nktv2p;
  const int n = nfunctions;
  Part list[BAND];

  // the density next to the floor, where the functions are linear and could not make the stress so

  double mine[2] = {0.0, 0.0}, lowest[2];
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_ground(i)) continue;
    const int count = parts(i, list);
    if (!count || list[0].k) continue;
    mine[0] += list[0].value * atom->rmass[i];
    mine[1] += list[0].value * field.points->jacobian(i) * atom->vfrac[i];
  }
  MPI_Allreduce(mine, lowest, 2, MPI_DOUBLE, MPI_SUM, world);
  if (!carried.empty()) lowest[0] -= carried[0] / (g * h);
  const double density = lowest[0] / lowest[1];
  const auto guess = [&](int i) {
    return density * g * (height(i) - where.top);
  };

  std::vector<double> sums((BAND + 1) * n, 0.0), all(sums.size());
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_ground(i)) continue;
    const double V = field.points->jacobian(i) * atom->vfrac[i];
    const int count = parts(i, list);
    for (int p = 0; p < count; p++) {
      const Part &a = list[p];
      if (a.k >= n) continue;
      sums[BAND * n + a.k] -= atom->rmass[i] * g * h * a.value + V * guess(i) * a.slope;
      for (int q = 0; q <= p; q++)
        sums[BAND * a.k + a.k - list[q].k] += V * a.slope * list[q].slope;
    }
  }
  MPI_Allreduce(sums.data(), all.data(), (int) sums.size(), MPI_DOUBLE, MPI_SUM, world);
  for (int k = 0; k < std::min(n, (int) carried.size()); k++) all[BAND * n + k] += carried[k];
  const auto factors = solve(all, std::vector<double>(all.begin() + BAND * n, all.end()));

  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_ground(i)) continue;
    double s = guess(i) + pressure(i);
    const int count = parts(i, list);
    for (int p = 0; p < count; p++)
      if (list[p].k < n) s += factors[list[p].k] * list[p].slope;
    const double J = field.points->jacobian(i);
    for (int c = 0; c < 6; c++)
      field.points->tau[i][c] = c < 3 ? J * (c == where.axis ? s : K0 * s) : 0.0;
  }
  check_laws();
}

/** Their state, for a step without motion. */
void MPMGeostatic::load(const std::vector<int> &list, const FixMPMMaterial *material) const
{
  Batch &batch = *field.batch;
  load_state(field, batch, list.data(), (int) list.size(), material);
  batch.dt = 1.0;
  for (int p = 0; p < batch.n; p++) {
    batch.heat[p] = batch.plastic[p] = 0.0;
    batch.Jold[p] = batch.J[p];
  }
  for (auto &row : batch.A) std::fill(row, row + batch.n, 0.0);
}

/** Laws that keep the elastic strain: that with which their stress is the one that points have,
 *  logarithmic and by Newton's method, with differences for derivatives. A stress beyond yield is
 *  that of no strain, and the one whose stress comes next to it is taken. first: its first history
 *  variable. */
void MPMGeostatic::strain(const std::vector<int> &list, const FixMPMMaterial *material,
                          int first) const
{
  constexpr int TURNS = 60;
  constexpr double START = -1.0e-6, DIFFERENCE = 1.0e-4, LONGEST = 0.02, CLOSE = 1.0e-13;
  Batch &batch = *field.batch;
  const int n = (int) list.size(), up = where.axis, aside = up ? 0 : 1;
  double e[2][BATCH], shift[2][BATCH], s[3][2][BATCH], next[2][BATCH], least[BATCH];
  std::fill_n(e[0], n, START);
  std::fill_n(e[1], n, START);
  std::fill_n(least, n, std::numeric_limits<double>::max());
  const auto stress = [&](int moved, double result[2][BATCH]) {
    load(list, material);
    for (int p = 0; p < n; p++)
      for (int c = 0; c < 6; c++) {
        const int which = c == up ? 0 : 1;
        const double mine = e[which][p] + (moved == which ? shift[which][p] : 0.0);
        batch.history[first + c][p] = c < 3 ? std::expm1(2.0 * mine) : 0.0;
      }
    material->material->update(batch);
    for (int p = 0; p < n; p++) {
      result[0][p] = batch.J[p] * batch.stress[up][p];
      result[1][p] = batch.J[p] * batch.stress[aside][p];
    }
  };
  bool open = true;
  for (int turn = 0; turn < TURNS && open; turn++) {
    for (int c = 0; c < 2; c++)
      for (int p = 0; p < n; p++) shift[c][p] = -DIFFERENCE * std::max(fabs(e[c][p]), -START);
    stress(-1, s[2]);
    stress(0, s[0]);
    stress(1, s[1]);
    open = false;
    for (int p = 0; p < n; p++) {
      const double *const tau = field.points->tau[list[p]];
      const double r[2] = {tau[up] - s[2][0][p], tau[aside] - s[2][1][p]};
      const double off = std::max(fabs(r[0]), fabs(r[1]));
      if (off < least[p]) {
        least[p] = off;
        for (int c = 0; c < 2; c++) next[c][p] = e[c][p];
      }
      if (off <= CLOSE * fabs(tau[up])) continue;
      double d[2][2];
      for (int k = 0; k < 2; k++)
        for (int c = 0; c < 2; c++) d[k][c] = (s[c][k][p] - s[2][k][p]) / shift[c][p];
      const double det = d[0][0] * d[1][1] - d[0][1] * d[1][0];
      if (det == 0.0) continue;
      const double step[2] = {(r[0] * d[1][1] - r[1] * d[0][1]) / det,
                              (r[1] * d[0][0] - r[0] * d[1][0]) / det};
      for (int c = 0; c < 2; c++) e[c][p] += std::clamp(step[c], -LONGEST, LONGEST);
      open = true;
    }
  }
  for (int p = 0; p < n; p++)
    for (int c = 0; c < 6; c++)
      material->history[list[p]][first + c] = c < 3 ? std::expm1(2.0 * next[c == up ? 0 : 1][p])
                                                    : 0.0;
}

/** A step without motion must not change the stress. Where it is beyond yield by less than the
 *  weight of a cell, and no deeper than a cell below the surface, points get what the law makes of
 *  it. */
void MPMGeostatic::check_laws()
{
  Batch &batch = *field.batch;
  double most = 0.0, changed = 0.0;
  bool deep = false;
  const double h = field.lattice.h;
  std::string name;
  each_material_batch(field, [&](const std::vector<int> &list, const FixMPMMaterial *material) {
    const int first = material->find_history("elastic_xx");
    if (first >= 0) strain(list, material, first);
    load(list, material);
    material->material->update(batch);
    for (int p = 0; p < batch.n; p++) {
      const int i = list[p];
      double *const tau = field.points->tau[i];
      double change = 0.0;
      for (int c = 0; c < 6; c++) {
        const double now = batch.J[p] * batch.stress[c][p];
        change = std::max(change, fabs(now - tau[c]));
      }
      const double V = batch.J[p] * atom->vfrac[i];
      const double cell = atom->rmass[i] / V * where.weight * force->nktv2p * h;
      if (change <= SAME * cell) continue;
      changed += 1.0;
      deep = deep || height(i) < where.top - h;
      for (int c = 0; c < 6; c++) tau[c] = batch.J[p] * batch.stress[c][p];
      for (int k = 0; k < material->nhistory; k++) material->history[i][k] = batch.history[k][p];
      if (change / cell > most) {
        most = change / cell;
        name = material->id;
      }
    }
  });
  if (most > 1.0 || deep)
    error->one(
        FLERR, Error::NOLASTLINE,
        "{}: the law of fix mpm/material {} does not keep the stress, by {:.3g} times the weight "
        "of a cell: use K0 within its yield surface, and linear or a law for soils such as "
        "mohr/coulomb, not one whose stress follows from the deformation",
        who, name, most);
  double all[2];
  MPI_Allreduce(&changed, &all[0], 1, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&most, &all[1], 1, MPI_DOUBLE, MPI_MAX, world);
  if (all[0] > 0.0 && comm->me == 0)
    error->warning(
        FLERR,
        "{}: the stress of {:.0f} points next to the surface is beyond yield, by up to {:.3g} "
        "times the weight of a cell; they get that of their law, and will not be quite at rest",
        who, all[0], all[1]);
}
