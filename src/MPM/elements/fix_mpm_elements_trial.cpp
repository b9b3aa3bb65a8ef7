/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Elements after a trial motion of an implicit solver. They work as in a step, and their state is
// then restored. The stiffness of each is found from central differences, one component of one of
// its nodes at a time, in all elements at once.

#include "elements/fix_mpm_elements.h"

#include "elements/fix_mpm_elements_work.h"

#include "atom.h"
#include "comm.h"
#include "force.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double DIFFERENCE = 1.0e-5;    // relative to the shortest element

/** Stores the trial displacements, also of nodes that are points of other ranks. */
void FixMPMElements::take_motion(const double *u)
{
  const int nlocal = atom->nlocal;
  motion.assign(3 * (std::size_t)(nlocal + atom->nghost), 0.0);
  std::copy_n(u, 3 * (std::size_t) nlocal, motion.data());
  comm->forward_comm(this, 3);
}

int FixMPMElements::pack_forward_comm(int n, int *list, double *buf, int, int *)
{
  for (int k = 0; k < n; k++) std::copy_n(&motion[3 * (std::size_t) list[k]], 3, buf + 3 * k);
  return 3 * n;
}

void FixMPMElements::unpack_forward_comm(int n, int first_one, double *buf)
{
  std::copy_n(buf, 3 * (std::size_t) n, &motion[3 * (std::size_t) first_one]);
}

/** Calls use(element, its number of nodes, forces on them [force]) with the state after the motion,
 *  and restores the state. Returns false if it is not finite. */
template <class Use> bool FixMPMElements::try_elements(const Use &use)
{
  const std::vector<double> before = pool;
  const double scale = 1.0 / force->nktv2p;
  bool good = true;
  trying = &good;
  for_trial_batches([&](Work &w) {
    if (good) material_update(w, false);
    for (const auto &element : w.elements) {
      double f[MAX_ELEMENT_NODES][3] = {{0.0}};
      if (good) find_forces(w, element.start, element.rule, f);
      for (int m = 0; m < element.rule.nnode; m++)
        for (int d = 0; d < dim; d++) {
          f[m][d] *= -scale;
          good = good && std::isfinite(f[m][d]);
        }
      if (good) use(element.number, element.rule.nnode, f);
    }
  });
  trying = nullptr;
  std::copy(before.begin(), before.end(), pool.begin());
  return good;
}

/** Positions of nodes relative to the first one, after the motion or before. */
void FixMPMElements::find_moved(std::size_t e, bool moved, double (*x)[3]) const
{
  const auto first = (std::size_t) nodes[e][0];
  for (int m = 0; m < nodes_of(row(e)); m++)
    for (int d = 0; d < 3; d++) {
      const auto here = (std::size_t) nodes[e][m];
      x[m][d] = atom->x[here][d] - atom->x[first][d];
      if (moved && d < dim) x[m][d] += motion[3 * here + d] - motion[3 * first + d];
    }
}

/** Adds to sent, times a sign, the pressure of this step on the surfaces as they are after the
 *  motion or before. */
void FixMPMElements::add_pressure_after(bool moved, double sign)
{
  const double factor = sign * side * pressure_before / (force->nktv2p * dim);
  for (std::size_t e = 0; e < nodes.size(); e++) {
    const bool four = nodes_of(row(e)) == 4;
    double x[MAX_ELEMENT_NODES][3] = {{0.0}}, normal[3];
    find_moved(e, moved, x);
    for (int part = 0; part < (four ? 4 : 1); part++) {
      const double *at[3];
      for (int m = 0; m < 3; m++) at[m] = x[SPLIT[part][m]];
      area_vector(dim, at, normal);
      for (int m = 0; m < dim; m++)
        for (int d = 0; d < dim; d++)
          sent[3 * (std::size_t) nodes[e][SPLIT[part][m]] + d] +=
              (four ? 0.5 : 1.0) * factor * normal[d];
    }
  }
}

/** Adds the derivative of the pressure on surfaces. An enclosed volume has a symmetric second
 *  derivative, so each face gets the symmetric part. */
void FixMPMElements::differentiate_pressure()
{
  const int size = maxnode * dim;
  const double factor = side * pressure_before / (force->nktv2p * dim);
  for (std::size_t e = 0; e < nodes.size(); e++) {
    const bool four = nodes_of(row(e)) == 4;
    double x[MAX_ELEMENT_NODES][3] = {{0.0}};
    find_moved(e, true, x);
    for (int part = 0; part < (four ? 4 : 1); part++) {
      const double *at[3];
      double high[3], low[3], K[9][9];
      for (int m = 0; m < 3; m++) at[m] = x[SPLIT[part][m]];
      for (int column = 0; column < dim * dim; column++) {
        // the area is linear, or bilinear, in the positions of nodes, so that differences of any
        // size are exact
        double &place = x[SPLIT[part][column / dim]][column % dim];
        const double value = place;
        place = value + 0.5 * shortest;
        area_vector(dim, at, high);
        place = value - 0.5 * shortest;
        area_vector(dim, at, low);
        place = value;
        for (int row = 0; row < dim * dim; row++)
          K[row][column] =
              (four ? 0.5 : 1.0) * factor * (high[row % dim] - low[row % dim]) / shortest;
      }
      const auto local = [&](int k) {
        return dim * SPLIT[part][k / dim] + k % dim;
      };
      for (int column = 0; column < dim * dim; column++)
        for (int row = 0; row < dim * dim; row++)
          tangents[e * size * size + (std::size_t) size * local(column) + local(row)] +=
              kind.closed ? 0.5 * (K[row][column] + K[column][row]) : K[row][column];
    }
  }
}

/** Sums the values of nodes in sent [local and ghost][3] over ranks, and adds those of this rank to
 *  the array to. */
void FixMPMElements::bring_home(double *to)
{
  comm->reverse_comm(this, 3);
  for (std::size_t k = 0; k < 3 * (std::size_t) atom->nlocal; k++) to[k] += sent[k];
  sent.clear();
}

bool FixMPMElements::forces_after(const double *u, double *f, double &carried)
{
  take_motion(u);
  sent.assign(motion.size(), 0.0);
  const bool good = try_elements([&](std::size_t e, int nnode, const double(*on)[3]) {
    for (int m = 0; m < nnode; m++) {
      double square = 0.0;
      for (int d = 0; d < dim; d++) {
        sent[3 * (std::size_t) nodes[e][m] + d] += on[m][d];
        square += on[m][d] * on[m][d];
      }
      carried += std::sqrt(square);
    }
  });
  // forces() does not include the pressure on open surfaces at the start
  if (pressure) add_pressure_after(true, 1.0);
  if (pressure && !kind.closed) add_pressure_after(false, -1.0);
  std::fill_n(f, 3 * (std::size_t) atom->nlocal, 0.0);
  bring_home(f);
  return good;
}

double FixMPMElements::differentiate(const double *u)
{
  take_motion(u);
  const int size = maxnode * dim;
  tangents.assign(pool.size() / stride * size * size, 0.0);
  const double step = DIFFERENCE * shortest;
  double sum = 0.0;
  for (int column = 0; column < size; column++)
    for (const double sign : {-1.0, 1.0}) {
      shifted_node = column / dim;
      shift[0] = shift[1] = shift[2] = 0.0;
      shift[column % dim] = sign * step;
      try_elements([&](std::size_t e, int nnode, const double(*on)[3]) {
        double *const K = &tangents[e * size * size + (std::size_t) size * column];
        for (int m = 0; m < nnode; m++)
          for (int d = 0; d < dim; d++) K[dim * m + d] += sign * on[m][d] / (2.0 * step);
      });
    }
  shifted_node = -1;
  if (pressure) differentiate_pressure();
  for (std::size_t e = 0; e < pool.size() / stride; e++) {
    double most = 0.0;
    for (int k = 0; k < size * size; k++)
      most = std::max(most, std::fabs(tangents[e * size * size + k]));
    sum += most * shortest;
  }
  return sum;
}

void FixMPMElements::add_change(const double *du, double *dforce)
{
  take_motion(du);
  sent.assign(motion.size(), 0.0);
  const int size = maxnode * dim;
  for (std::size_t e = 0; e < pool.size() / stride; e++) {
    const double *K = &tangents[e * size * size];
    const int nnode = nodes_of(row(e));
    for (int a = 0; a < nnode; a++)
      for (int b = 0; b < dim; b++, K += size) {
        const double moved = motion[3 * (std::size_t) nodes[e][a] + b];
        for (int m = 0; m < nnode; m++)
          for (int d = 0; d < dim; d++)
            sent[3 * (std::size_t) nodes[e][m] + d] += K[dim * m + d] * moved;
      }
  }
  bring_home(dforce);
}

void FixMPMElements::add_blocks(double *blocks)
{
  const int size = maxnode * dim;
  const std::size_t nall = (std::size_t) atom->nlocal + atom->nghost;
  std::vector<double> column(3 * (std::size_t) atom->nlocal);
  for (int b = 0; b < dim; b++) {
    sent.assign(3 * nall, 0.0);
    for (std::size_t e = 0; e < pool.size() / stride; e++)
      for (int m = 0; m < nodes_of(row(e)); m++)
        for (int d = 0; d < dim; d++)
          sent[3 * (std::size_t) nodes[e][m] + d] -=
              tangents[e * size * size + (std::size_t) size * (dim * m + b) + dim * m + d];
    std::fill(column.begin(), column.end(), 0.0);
    bring_home(column.data());
    for (int i = 0; i < atom->nlocal; i++)
      for (int d = 0; d < dim; d++)
        blocks[(std::size_t) i * dim * dim + dim * d + b] += column[3 * (std::size_t) i + d];
  }
}

double FixMPMElements::asymmetry() const
{
  const int size = maxnode * dim;
  double most = 0.0, largest = 0.0;
  for (std::size_t e = 0; e < pool.size() / stride; e++)
    for (int k = 0; k < size; k++)
      for (int l = 0; l < size; l++) {
        const double *const K = &tangents[e * size * size];
        most = std::max(most, std::fabs(K[size * k + l] - K[size * l + k]));
        largest = std::max(largest, std::fabs(K[size * k + l]));
      }
  return largest > 0.0 ? most / largest : 0.0;
}
