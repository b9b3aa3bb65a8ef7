/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Elements after a trial motion of an implicit solver. The stiffness of each is found from central differences, one component of one of
// its nodes at a time, in all elements at once.

#include "elements/fix_mpm_elements.h"

#include "atom.h"
#include "comm.h"

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
  ElementForces::Trial trial{motion.data()};
  const bool good =
      internal->try_motion(trial, [&](std::size_t e, int nnode, const double(*on)[3]) {
        for (int m = 0; m < nnode; m++) {
          double square = 0.0;
          for (int d = 0; d < dim; d++) {
            sent[3 * (std::size_t) body->nodes[e][m] + d] += on[m][d];
            square += on[m][d] * on[m][d];
          }
          carried += std::sqrt(square);
        }
      });
  // forces() does not include the pressure on open surfaces at the start
  if (surface->pressure) surface->add_pressure_after(motion.data(), 1.0, sent.data());
  if (surface->pressure && !surface->kind.closed)
    surface->add_pressure_after(nullptr, -1.0, sent.data());
  std::fill_n(f, 3 * (std::size_t) atom->nlocal, 0.0);
  bring_home(f);
  return good;
}

double FixMPMElements::differentiate(const double *u)
{
  take_motion(u);
  const int size = body->maxnode * dim;
  tangents.assign(body->size() * size * size, 0.0);
  const double step = DIFFERENCE * internal->shortest;
  double sum = 0.0;
  for (int column = 0; column < size; column++)
    for (const double sign : {-1.0, 1.0}) {
      ElementForces::Trial trial{motion.data()};
      trial.shifted_node = column / dim;
      trial.shift[column % dim] = sign * step;
      internal->try_motion(trial, [&](std::size_t e, int nnode, const double(*on)[3]) {
        double *const K = &tangents[e * size * size + (std::size_t) size * column];
        for (int m = 0; m < nnode; m++)
          for (int d = 0; d < dim; d++) K[dim * m + d] += sign * on[m][d] / (2.0 * step);
      });
    }
  if (surface->pressure)
    surface->differentiate_pressure(motion.data(), internal->shortest, tangents.data());
  for (std::size_t e = 0; e < body->size(); e++) {
    double most = 0.0;
    for (int k = 0; k < size * size; k++)
      most = std::max(most, std::fabs(tangents[e * size * size + k]));
    sum += most * internal->shortest;
  }
  return sum;
}

void FixMPMElements::add_change(const double *du, double *dforce)
{
  take_motion(du);
  sent.assign(motion.size(), 0.0);
  const int size = body->maxnode * dim;
  for (std::size_t e = 0; e < body->size(); e++) {
    const double *K = &tangents[e * size * size];
    const int nnode = body->nodes_of(body->row(e));
    for (int a = 0; a < nnode; a++)
      for (int b = 0; b < dim; b++, K += size) {
        const double moved = motion[3 * (std::size_t) body->nodes[e][a] + b];
        for (int m = 0; m < nnode; m++)
          for (int d = 0; d < dim; d++)
            sent[3 * (std::size_t) body->nodes[e][m] + d] += K[dim * m + d] * moved;
      }
  }
  bring_home(dforce);
}

void FixMPMElements::add_blocks(double *blocks)
{
  const int size = body->maxnode * dim;
  const std::size_t nall = (std::size_t) atom->nlocal + atom->nghost;
  std::vector<double> column(3 * (std::size_t) atom->nlocal);
  for (int b = 0; b < dim; b++) {
    sent.assign(3 * nall, 0.0);
    for (std::size_t e = 0; e < body->size(); e++)
      for (int m = 0; m < body->nodes_of(body->row(e)); m++)
        for (int d = 0; d < dim; d++)
          sent[3 * (std::size_t) body->nodes[e][m] + d] -=
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
  const int size = body->maxnode * dim;
  double most = 0.0, largest = 0.0;
  for (std::size_t e = 0; e < body->size(); e++)
    for (int k = 0; k < size; k++)
      for (int l = 0; l < size; l++) {
        const double *const K = &tangents[e * size * size];
        most = std::max(most, std::fabs(K[size * k + l] - K[size * l + k]));
        largest = std::max(largest, std::fabs(K[size * k + l]));
      }
  return largest > 0.0 ? most / largest : 0.0;
}
