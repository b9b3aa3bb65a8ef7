/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fracture/mpm_split_nodes.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "base/mpm_points.h"
#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// mass of a side over that of the node, below which it is no side
static constexpr double LEAST_SHARE = 1.0e-10;

MPMSplitNodes::MPMSplitNodes(LAMMPS *lmp, MPMField &field) :
    Pointers(lmp), gaps(lmp, field), field(field), dim(field.lattice.dim)
{
}

/** Calls f(node, index, weight, r) for the nodes of point i. */
template <class F>
static void each_node(const MPMField &field, const Grid::Block &block, int i, const F &f)
{
  const MPMStencil stencil(field);
  const auto &lattice = field.lattice;
  const double *const x = field.frame->places()[i];
  int first[3], count[3], k[3];
  double w[3][4], dw[3][4], r[3] = {0.0, 0.0, 0.0};
  stencil.along_axes(i, x, first, count, w, dw);
  for (k[0] = 0; k[0] < count[0]; k[0]++)
    for (k[1] = 0; k[1] < count[1]; k[1]++)
      for (k[2] = 0; k[2] < count[2]; k[2]++) {
        const int index[3] = {first[0] + k[0], first[1] + k[1], first[2] + k[2]};
        for (int d = 0; d < lattice.dim; d++)
          r[d] = (x[d] - lattice.origin[d]) / lattice.h - index[d];
        f(field.grid.locate_near(block, index), index, w[0][k[0]] * w[1][k[1]] * w[2][k[2]], r);
      }
}

/** The reals of a node in a tile. */
double *MPMSplitNodes::tile_entry(double *tile, int width, const int *base, const int *index) const
{
  const int order = stencil_order(field.options.shape);
  int entry = (index[0] - base[0]) * tile_stride_x(dim, order) +
      (index[1] - base[1]) * tile_stride_y(dim, order);
  if (dim == 3) entry += index[2] - base[2];
  return tile + width * entry;
}

/** Sums of the sides, with the kernel of the step for one point at a time. */
void MPMSplitNodes::find_records(const double *opening)
{
  const int OTHERS = 2 * NREAL, width = OTHERS + 3;    // volume; weight and opening of surfaces
  MPMPointMap &map = *field.map;
  // these keep the velocity of the start of the step, also where the nodes do not
  const auto to_nodes = field.frame->kernels(
      field.options.strains_by_gradient() ? TPIC : field.options.transfer, true);
  const PointRows r = field.rows();
  const TransferStep s = field.step_data();
  points.clear();
  gaps.clear(sums, width);
  gaps.each_point_near([&](const MPMPointMap::ActiveBlock &a, int run, int i) {
    const auto &block = field.grid.blocks[a.slot];
    bool has_any = false;
    each_node(field, block, i, [&](int64_t n, const int *, double, const double *) {
      has_any = has_any || gaps.at[n] >= 0;
    });
    if (!has_any) return;
    int base[3];
    map.tile_base(a, base);
    points.push_back({i, run});
    MPMPointMap::Run one = map.runs[run];
    one.first = i;
    one.last = i + 1;
    int box[6];
    reset_box(box);
    run_to_tile(field, to_nodes.p2g, r, s, one, base, box);
    const double V = gaps.volume(i);
    const bool on_surface = gaps.is_on_surface(i);
    each_node(field, block, i,
              [&](int64_t n, const int *index, double weight, const double *place) {
                double *const entry = tile_entry(map.tile, NREAL, base, index);
                const int k = gaps.at[n];
                if (k >= 0) {
                  double *const node = &sums[width * n];
                  double *const side = node + NREAL * gaps.side_of(gaps.list[k], i, place);
                  for (int lane = 0; lane < NREAL; lane++) side[lane] += entry[lane];
                  node[OTHERS] += V * weight;
                  if (on_surface) {
                    node[OTHERS + 1] += V * weight;
                    node[OTHERS + 2] += V * weight * opening[i];
                  }
                }
                std::fill_n(entry, NREAL, 0.0);
              });
  });
  rising.resize(points.size());
  std::iota(rising.begin(), rising.end(), 0);
  std::sort(rising.begin(), rising.end(), [this](int a, int b) {
    return points[a].i < points[b].i;
  });
  gaps.sum(sums, width);

  // what points reach with next to no mass is no side
  std::vector<MPMSurfaceGaps::Node> kept;
  records.clear();
  for (auto &node : gaps.list) {
    const double *const found = &sums[width * node.number], a = found[3], b = found[NREAL + 3];
    gaps.at[node.number] = -1;
    if (!(std::min(a, b) > LEAST_SHARE * (a + b))) continue;
    gaps.at[node.number] = (int) kept.size();
    node.filled = found[OTHERS] / field.lattice.cell_volume();
    node.opening = found[OTHERS + 1] > 0.0 ? found[OTHERS + 2] / found[OTHERS + 1] : 0.0;
    kept.push_back(node);
    records.insert(records.end(), found, found + OTHERS);
  }
  gaps.list.swap(kept);
}

bool MPMSplitNodes::find(const MPMSurfaceGaps::Surface &surface)
{
  nreal = field.kernel.nreal;
  points.clear();
  records.clear();
  gaps.find(surface);
  int mine = !gaps.list.empty(), any;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (!any) return false;
  find_records(surface.opening);
  field.kernels->solve_nodes(records.data(), 2 * (int) gaps.list.size(), NREAL, field.step_dt(),
                             field.least_node_mass);
  // forces that points do not give are for both sides alike
  remembered.assign(gaps.list.size() * nreal, 0.0);
  for (int k = 0; k < (int) gaps.list.size(); k++) {
    const double *const a = record(k, 0), *const b = record(k, 1);
    double *const both = &remembered[(std::size_t) k * nreal];
    for (int lane = 0; lane < nreal; lane++)
      if (lane % 4 < 3) both[lane] = (a[3] * a[lane] + b[3] * b[lane]) / (a[3] + b[3]);
  }
  follow({});
  return !gaps.list.empty();
}

void MPMSplitNodes::remember()
{
  for (std::size_t k = 0; k < gaps.list.size(); k++)
    std::copy_n(field.grid.record(gaps.list[k].number), nreal, &remembered[k * nreal]);
}

void MPMSplitNodes::follow(const std::vector<char> &held)
{
  field.nodes.complete_velocities();    // of periodic images, which may be in the list
  for (int k = 0; k < (int) gaps.list.size(); k++) {
    const double *const now = field.grid.record(gaps.list[k].number);
    const double *const before = &remembered[(std::size_t) k * nreal];
    const char bits = held.empty() ? 0 : held[gaps.list[k].number];
    for (const int side : {0, 1})
      for (int lane = 0; lane < nreal; lane++) {
        if (lane % 4 == 3) continue;
        double &velocity = record(k, side)[lane];
        velocity = bits >> lane % 4 & 1 ? now[lane] : velocity + now[lane] - before[lane];
      }
  }
  remember();
}

void MPMSplitNodes::find_motion()
{
  MPMPointMap &map = *field.map;
  const auto &kernel = field.kernel;
  const PointRows r = field.rows();
  const TransferStep s = field.step_data();
  const bool in_C = kernel.gradient_in_C, by_gradient = field.options.strains_by_gradient();
  const int nC = dim * dim;
  motion.assign(points.size() * MOTION, 0.0);
  double velocity[3 * BATCH], place[3 * BATCH], C[9 * BATCH], L[9 * BATCH];
  std::vector<std::array<double, 9>> saved;    // entries of the tile
  std::size_t next = 0;
  for (const auto &a : map.active) {
    if (next == points.size() || points[next].run >= a.last_run) continue;
    int base[3];
    map.load_tile(a, base, false);
    for (; next < points.size() && points[next].run < a.last_run; next++) {
      const int i = points[next].i;
      const auto &block = field.grid.blocks[a.slot];
      saved.clear();
      const auto exchange = [&](bool back) {
        std::size_t n_saved = 0;
        each_node(field, block, i,
                  [&](int64_t n, const int *index, double, const double *from_node) {
                    const int k = gaps.at[n];
                    if (k < 0) return;
                    double *const entry = tile_entry(map.tile_load, nreal, base, index);
                    if (back) {
                      std::copy_n(saved[n_saved++].data(), nreal, entry);
                      return;
                    }
                    saved.emplace_back();
                    std::copy_n(entry, nreal, saved.back().data());
                    std::copy_n(record(k, gaps.side_of(gaps.list[k], i, from_node)), nreal, entry);
                  });
      };
      exchange(false);
      PointRows one = rows_from(field, r, i);
      std::copy_n(atom->v[i], 3, velocity);
      if (r.C) std::copy_n(r.C + (bigint) nC * i, nC, C);
      one.v = velocity;
      one.C = r.C ? C : nullptr;
      one.xnew = place;
      if (by_gradient) kernel.g2p_gradient(one, s, 0, 1, base, map.tile_load, L);
      map.drifted |=
          kernel.g2p(one, s, 0, 1, base, map.tile_load, in_C || by_gradient ? nullptr : L);
      exchange(true);
      double *const found = &motion[next * MOTION];
      std::copy_n(velocity, 3, found);
      std::copy_n(place, 3, found + 3);
      if (r.C) std::copy_n(C, nC, found + 6);
      std::copy_n(in_C && !by_gradient ? C : L, nC, found + 15);
    }
  }
}

void MPMSplitNodes::set_motion()
{
  double *const C = field.affine ? field.affine->rows() : nullptr;
  for (std::size_t k = 0; k < points.size(); k++) {
    const double *const found = &motion[k * MOTION];
    const int i = points[k].i;
    std::copy_n(found, 3, atom->v[i]);
    std::copy_n(found + 3, dim, atom->x[i]);
    if (C) std::copy_n(found + 6, dim * dim, C + (bigint) dim * dim * i);
  }
}

void MPMSplitNodes::open_points(double *opening, double most) const
{
  const MPMPointMap &map = *field.map;
  for (const auto &point : points) {
    const auto &block = field.grid.blocks[map.runs[point.run].slot];
    double change = 0.0, weights = 0.0;
    each_node(field, block, point.i, [&](int64_t n, const int *, double weight, const double *) {
      if (gaps.at[n] < 0) return;
      weights += weight;
      change += weight * gaps.list[gaps.at[n]].change;
    });
    if (weights > 0.0)
      opening[point.i] = std::min(most, std::max(0.0, opening[point.i] + change / weights));
  }
}

std::vector<int>::const_iterator MPMSplitNodes::first_from(int i) const
{
  return std::lower_bound(rising.begin(), rising.end(), i, [this](int k, int from) {
    return points[k].i < from;
  });
}

bool MPMSplitNodes::has_points(int first, int n) const
{
  const auto at = first_from(first);
  return at != rising.end() && points[*at].i < first + n;
}

void MPMSplitNodes::set_gradients(int first, int n, double *L) const
{
  for (auto at = first_from(first); at != rising.end() && points[*at].i < first + n; at++)
    std::copy_n(&motion[(std::size_t) *at * MOTION + 15], dim * dim,
                L + dim * dim * (points[*at].i - first));
}

double MPMSplitNodes::memory_usage() const
{
  return gaps.memory_usage() + bytes_of(sums, records, remembered, points, rising, motion);
}
