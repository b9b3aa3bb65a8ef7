/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The velocities of the nodes in a plane across the axis become their mean, weighted by their
   masses m,

     v_k = sum_i m_i v_i / sum_i m_i

   The functions of the nodes in a plane sum to a function of the height alone: strains are those of
   ground without end, and its forces sum_i f_i are, too, as the stress at the free sides has no
   part in them. So the column obeys the equations of the lattice in one dimension, with all that
   the material does. Old velocities become their mean, too: where layers have moved by different
   ways, nodes at the sides see more of one of them, and FLIP would keep that. The mean is a
   projection, orthogonal with the masses, and does no work.

   Columns beside a model: P.A. Cundall, H. Hansteen, S. Lacasse, P.B. Selnes, NESSI, report
   51508-9, Norwegian Geotechnical Institute (1980); O.C. Zienkiewicz, N. Bicanic, F.Q. Shen, in
   Advances in Computational Nonlinear Mechanics, Springer (1989) 109.
------------------------------------------------------------------------- */

#include "loads/fix_mpm_column.h"

#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_stencil.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"

#include <algorithm>
#include <climits>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double ONE_LAYER =
    0.25;    // of the distance of points: these are in the same layer

/** fix ID all mpm/column fix-ID x|y|z. */
FixMPMColumn::FixMPMColumn(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  using namespace option;
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/column acts on all points of a fix mpm: use group all");
  Options options("fix mpm/column");
  options.argument(text(of, "fix-ID"));
  std::vector<OptionWord> axes = {{"x", 0}, {"y", 1}};
  if (domain->dimension == 3) axes.push_back({"z", 2});
  options.argument(word(axis, axes, "axis"));
  read_options(lmp, options, narg, arg, 3);
  dynamic_group_allow = 1;
}

/** Without a fix mpm nobody calls init_action(). */
void FixMPMColumn::init()
{
  require_field(lmp, *this);
}

MPMField &FixMPMColumn::ground() const
{
  MPMField *const found = MPMField::find(lmp, of);
  if (!found)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/column {}: there is no fix mpm with the ID {}, whose points would be the "
               "column",
               id, of);
  return *found;
}

void FixMPMColumn::init_action()
{
  field = &ground();
  if (domain->periodicity[axis])
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/column {} stands along {}, where the box is periodic: use boundary f", id,
               "xyz"[axis]);
  refuse_field(lmp, *this, *field,
               {{field->options.axisymmetric, "axisymmetric", "use a plane or 3d"},
                {field->options.modified_edges, "edges modified", "use edges plain, the default"},
                {field->options.has_fmpm(), "transfer fmpm",
                 "its terms differ in a plane of nodes: use another transfer"}});
  field->keep_old_velocities();
  fresh = true;
}

/** The stress at the start of each step, by layers of points. */
void FixMPMColumn::setup(int)
{
  find_layers();
  if (layers.empty())
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/column {}: fix mpm {} has no points", id, of);
}

void FixMPMColumn::find_layers()
{
  const auto places = field->frame->places();
  std::vector<Layer> here;
  double mine_volume[2] = {0.0, 0.0}, all_volume[2];
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field->is_point(i) || field->is_element_node(i)) continue;
    Layer point = {atom->vfrac[i] * field->points->jacobian(i), places[i][axis], {}};
    field->points->cauchy(i, point.sigma);
    mine_volume[0] += point.volume;
    mine_volume[1] += 1.0;
    here.push_back(point);
  }
  MPI_Allreduce(mine_volume, all_volume, 2, MPI_DOUBLE, MPI_SUM, world);
  const double same =
      ONE_LAYER * std::pow(all_volume[0] / std::max(all_volume[1], 1.0), 1.0 / domain->dimension);

  // points of a layer are as high to round-off: those of this rank first, which may be many
  const auto join = [same](std::vector<Layer> &list) {
    std::sort(list.begin(), list.end(), [](const Layer &a, const Layer &b) {
      return a.height < b.height;
    });
    std::vector<Layer> joined;
    double bottom = 0.0;
    for (const auto &one : list) {
      if (joined.empty() || one.height > bottom + same) {
        joined.push_back(one);
        bottom = one.height;
        continue;
      }
      Layer &layer = joined.back();
      const double volume = layer.volume + one.volume, share = one.volume / volume;
      layer.volume = volume;
      layer.height += share * (one.height - layer.height);
      for (int c = 0; c < 6; c++) layer.sigma[c] += share * (one.sigma[c] - layer.sigma[c]);
    }
    list = joined;
  };
  join(here);
  static constexpr int NREAL = sizeof(Layer) / sizeof(double);
  const int count = (int) here.size() * NREAL;
  std::vector<int> counts(comm->nprocs), first(comm->nprocs + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int p = 0; p < comm->nprocs; p++) first[p + 1] = first[p] + counts[p];
  layers.resize(first[comm->nprocs] / NREAL);
  MPI_Allgatherv(here.data(), count, MPI_DOUBLE, layers.data(), counts.data(), first.data(),
                 MPI_DOUBLE, world);
  join(layers);
  most_apart = 0.0;
  for (std::size_t k = 1; k < layers.size(); k++)
    most_apart = std::max(most_apart, layers[k].height - layers[k - 1].height);
}

void FixMPMColumn::stress(double height, double sigma[6]) const
{
  const auto above =
      std::upper_bound(layers.begin(), layers.end(), height, [](double h, const Layer &layer) {
        return h < layer.height;
      });
  const std::size_t n = layers.size();
  const std::size_t k =
      std::clamp<std::size_t>(above - layers.begin(), 1, std::max<std::size_t>(n, 2) - 1);
  const Layer &low = layers[k - 1], &high = layers[std::min(k, n - 1)];
  const double distance = high.height - low.height;
  const double t = distance > 0.0 ? std::clamp((height - low.height) / distance, -0.5, 1.5) : 0.0;
  for (int c = 0; c < 6; c++) sigma[c] = low.sigma[c] + t * (high.sigma[c] - low.sigma[c]);
}

/** Those of the blocks of all ranks. */
void FixMPMColumn::find_rows()
{
  int mine_ends[2] = {INT_MAX, INT_MAX}, ends[2];    // the first one, minus the last one
  for (const auto &block : field->grid.blocks) {
    const int low = block.b[axis] * field->grid.side;
    mine_ends[0] = std::min(mine_ends[0], low);
    mine_ends[1] = std::min(mine_ends[1], -(low + field->grid.side - 1));
  }
  MPI_Allreduce(mine_ends, ends, 2, MPI_INT, MPI_MIN, world);
  first_row = ends[0];
  mine.resize((std::size_t) WIDTH * std::max(0, -ends[1] - ends[0] + 1));
  rows.resize(mine.size());
  fresh = false;
}

/** Before any other action, as the free sides have forces, and after each of them. */
void FixMPMColumn::level(Stage stage)
{
  if (stage == TRIAL) return;
  if (fresh) find_rows();
  Grid &grid = field->grid;
  const int dim = grid.lattice.dim;
  const bool has_old = grid.nreal == 8 && stage == STEP;
  std::fill(mine.begin(), mine.end(), 0.0);
  const auto visit = [&](const auto &f) {
    for (int64_t node = 0; node < grid.nnodes(); node++) {
      double *const record = grid.record(node);
      if (!(record[3] > 0.0)) continue;
      int index[3];
      grid.node_index(node, index);
      f(node, record, (std::size_t) WIDTH * (index[axis] - first_row));
    }
  };
  visit([&](int64_t node, const double *record, std::size_t at) {
    if (!grid.owns(node)) return;
    double *const row = &mine[at], m = record[3];
    row[0] += m;
    for (int d = 0; d < dim; d++) {
      row[1 + d] += m * record[d];
      if (has_old) row[4 + d] += m * record[4 + d];
    }
  });
  MPI_Allreduce(mine.data(), rows.data(), (int) mine.size(), MPI_DOUBLE, MPI_SUM, world);
  visit([&](int64_t node, double *record, std::size_t at) {
    const double *const row = &rows[at];
    double change[3] = {0.0, 0.0, 0.0}, change_old[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim && row[0] > 0.0; d++) {
      change[d] = row[1 + d] / row[0] - record[d];
      record[d] += change[d];
      if (!has_old) continue;
      change_old[d] = row[4 + d] / row[0] - record[4 + d];
      record[4 + d] += change_old[d];
    }
    // sum_i m_i change_i = 0 in a plane, and so is the work
    if (has_old && field->ledger.on && grid.owns(node))
      field->ledger.note_push(record, change, change_old);
  });
}

void FixMPMColumn::motion(double height, double old[3], double change[3]) const
{
  const auto &lattice = field->lattice;
  int first;
  double w[4], mass = 0.0, sum[6] = {};
  const int n = MPMStencil(*field).weights((height - lattice.origin[axis]) / lattice.h, first, w);
  const int nrows = (int) (rows.size() / WIDTH);
  for (int k = 0; k < n; k++) {
    const int at = first + k - first_row;
    if (at < 0 || at >= nrows || !(rows[WIDTH * at] > 0.0)) continue;
    const double *const row = &rows[WIDTH * at];
    mass += w[k];
    for (int d = 0; d < 6; d++) sum[d] += w[k] * row[1 + d] / row[0];
  }
  for (int d = 0; d < 3; d++) {
    old[d] = mass > 0.0 ? sum[3 + d] / mass : 0.0;
    change[d] = mass > 0.0 ? sum[d] / mass - old[d] : 0.0;
  }
}

double FixMPMColumn::memory_usage()
{
  return (double) ((mine.capacity() + rows.capacity()) * sizeof(double) +
                   layers.capacity() * sizeof(Layer));
}
