/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fracture/mpm_free_surface.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_nodes.h"
#include "field/mpm_passes.h"
#include "field/mpm_plan.h"
#include "field/mpm_stencil.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// volume around a point, as a share of space, below which there is a surface; where points are
// irregular, this number of standard deviations of what they are above 1
static constexpr double MISSING = 0.05, DEVIATIONS = 3.0;
static constexpr int FINEST = 4;    // parts of a node spacing

/** Nodes of a lattice with as many parts of a node spacing as points have. Part s of node n is at
 *  n + (s + .5)/parts - .5, so that all that a point reaches belong to nodes that it reaches, and
 *  faces in planes of nodes are planes of symmetry. */
struct FineNodes {
  const MPMField &field;
  const int dim, order, parts, width;    // width: parts of all axes of a node
  std::vector<double> volume;            // [node][width]

  FineNodes(const MPMField &field, int parts) :
      field(field), dim(field.lattice.dim), order(std::min(2, stencil_order(field.options.shape))),
      parts(parts), width(dim == 3 ? parts * parts * parts : parts * parts),
      volume(width * field.grid.nnodes(), 0.0)
  {
  }

  /** Calls f(node*width + part, weight, slope) for the nodes that point i reaches, with the
   *  slopes of the weight along the axes, per part. */
  template <class F> void visit(const Grid::Block &block, int i, const F &f) const
  {
    const double *const x = field.frame->places()[i];
    int first[3] = {0, 0, 0}, count[3] = {1, 1, 1}, k[3];
    double w[3][4] = {{1.0}, {1.0}, {1.0}}, slope[3][4] = {{0.0}};
    for (int d = 0; d < dim; d++) {
      const double t = (x[d] - field.lattice.origin[d]) / field.lattice.h;
      const double at = parts * (t + 0.5) - 0.5;
      if (order == 2) {
        count[d] = MPMStencil::quadratic(at, first[d], w[d]);
        const double r = at - first[d] - 1.0;    // from the node in the middle
        slope[d][0] = r - 0.5;
        slope[d][1] = -2.0 * r;
        slope[d][2] = r + 0.5;
      } else {
        first[d] = (int) std::floor(at);
        count[d] = 2;
        w[d][1] = at - first[d];
        w[d][0] = 1.0 - w[d][1];
        slope[d][0] = -1.0;
        slope[d][1] = 1.0;
      }
    }
    for (k[0] = 0; k[0] < count[0]; k[0]++)
      for (k[1] = 0; k[1] < count[1]; k[1]++)
        for (k[2] = 0; k[2] < count[2]; k[2]++) {
          int index[3] = {0, 0, 0}, part = 0;
          for (int d = 0; d < dim; d++) {
            const int fine = first[d] + k[d];
            index[d] = (int) std::floor((double) fine / parts);
            part = parts * part + fine - parts * index[d];
          }
          const int64_t node = field.grid.locate_near(block, index);
          if (node < 0) continue;
          const double wx = w[0][k[0]], wy = w[1][k[1]], wz = w[2][k[2]];
          const double slopes[3] = {slope[0][k[0]] * wy * wz, wx * slope[1][k[1]] * wz,
                                    wx * wy * slope[2][k[2]]};
          f(node * width + part, wx * wy * wz, slopes);
        }
  }

  /** The part on the other side of a plane of nodes across an axis. */
  int mirrored(int part, int axis) const
  {
    int step = 1;
    for (int d = dim - 1; d > axis; d--) step *= parts;
    const int along = part / step % parts;
    return part + step * (parts - 1 - 2 * along);
  }
  double &at(int64_t node, int part) { return volume[node * width + part]; }

  /** Makes sums over all ranks of volumes; what is outside of a fixed face is its mirror image. */
  void sum()
  {
    MPMEdges faces(field.lmp, field);
    faces.find(true);
    for (int a = dim - 1; a >= 0; a--)
      for (const auto &e : faces.lists[a])
        for (int part = 0; part < width; part++) {
          const int other = mirrored(part, a);
          if (part <= other) at(e.face, part) += at(e.face, other);
          if (part < other) at(e.face, other) = at(e.face, part);
          if (e.outside >= 0) at(e.inside, other) += at(e.outside, part);
        }
    field.nodes.sum(volume.data(), width, 0, width);
    for (int a = 0; a < dim; a++)
      for (const auto &e : faces.lists[a])
        if (e.outside >= 0)
          for (int part = 0; part < width; part++)
            at(e.outside, part) = at(e.inside, mirrored(part, a));
    field.nodes.complete(volume.data(), width, width);
  }
};

void LAMMPS_NS::find_free_surface(MPMField &field, const std::function<bool(int)> &counts,
                                  std::vector<double> &normal)
{
  field.plan->find_blocks_now();
  const auto volume = [&field](int i) {
    return field.atom->vfrac[i] * field.points->jacobian(i);
  };
  const auto each = [&](const auto &use) {
    each_point(field, [&](const MPMPointMap::Run &run, int i) {
      if (counts(i)) use(field.grid.blocks[run.slot], i);
    });
  };
  double sums[2] = {0.0, 0.0};
  each([&](const Grid::Block &, int i) {
    sums[0] += volume(i);
    sums[1] += 1.0;
  });
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, field.lmp->world);
  if (!(sums[1] > 0.0)) return;

  const Lattice &lattice = field.lattice;
  const double size = std::pow(sums[0] / sums[1], 1.0 / lattice.dim);
  const int parts = std::max(1, std::min(FINEST, (int) std::lround(lattice.h / size)));
  FineNodes fine(field, parts);
  each([&](const Grid::Block &block, int i) {
    const double part = volume(i) * fine.width / lattice.cell_volume();
    fine.visit(block, i, [&](int64_t at, double weight, const double *) {
      fine.volume[at] += weight * part;
    });
  });
  fine.sum();
  std::vector<double> share(field.atom->nmax, 0.0);
  double above[2] = {0.0, 0.0};
  each([&](const Grid::Block &block, int i) {
    fine.visit(block, i, [&](int64_t at, double weight, const double *) {
      share[i] += weight * fine.volume[at];
    });
    if (share[i] < 1.0 - MISSING) return;
    const double more = std::max(0.0, share[i] - 1.0);
    above[0] += more * more;
    above[1] += 1.0;
  });
  MPI_Allreduce(MPI_IN_PLACE, above, 2, MPI_DOUBLE, MPI_SUM, field.lmp->world);
  const double deviation = above[1] > 0.0 ? std::sqrt(above[0] / above[1]) : 0.0;
  const double least = 1.0 - std::max(MISSING, DEVIATIONS * deviation);
  each([&](const Grid::Block &block, int i) {
    if (!(share[i] < least)) return;
    double *const n = &normal[3 * (std::size_t) i];
    fine.visit(block, i, [&](int64_t at, double, const double *slope) {
      for (int d = 0; d < 3; d++) n[d] -= slope[d] * fine.volume[at];
    });
    const double length = MathExtra::len3(n);
    for (int d = 0; d < 3; d++) n[d] = length > 0.0 ? n[d] / length : 0.0;
  });
}
