/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_fourier.h"

#include "flow/mpm_flow_lattice.h"

#include "comm.h"
#include "error.h"
#include "lammps.h"
#include "math_const.h"

#include <algorithm>
#include <cmath>

#ifdef MPM_FFTW
#include <fftw3.h>
#endif

using namespace LAMMPS_NS;
using MathConst::MY_PI;

#ifdef MPM_FFTW

/** The cells of the layers and of the lines that a rank has, and their transforms. Plans are
 *  estimated, so that rounding does not depend on a measurement. */
struct MPMFlowFourier::Transforms {
  struct Part {
    double *values = nullptr;
    std::size_t size = 0;
    fftw_plan plan[2] = {nullptr, nullptr};    // there, and back

    /** dim axes of n numbers, the slowest one first; many of them */
    void prepare(int dim, const int *n, int many, const fftw_r2r_kind kind[2][2])
    {
      clear();
      int length = 1;
      for (int d = 0; d < dim; d++) length *= n[d];
      size = (std::size_t) length * many;
      if (size == 0) return;
      values = fftw_alloc_real(size);
      for (int way = 0; way < 2; way++)
        plan[way] = fftw_plan_many_r2r(dim, n, many, values, nullptr, 1, length, values, nullptr, 1,
                                       length, kind[way], FFTW_ESTIMATE);
    }
    void execute(bool back) const
    {
      if (size) fftw_execute(plan[back]);
    }
    void clear()
    {
      for (auto &one : plan)
        if (one) fftw_destroy_plan(one);
      if (values) fftw_free(values);
      values = nullptr;
      plan[0] = plan[1] = nullptr;
      size = 0;
    }
    ~Part() { clear(); }
  };
  Part layers, lines;

  /** The transform of an axis, and the one back. */
  static fftw_r2r_kind kind(const Axis &a, bool back)
  {
    if (a.end[0] == PERIODIC) return back ? FFTW_HC2R : FFTW_R2HC;
    if (a.end[0] != a.end[1]) return a.end[0] == CLOSED ? FFTW_REDFT11 : FFTW_RODFT11;
    if (a.end[0] == CLOSED) return back ? FFTW_REDFT01 : FFTW_REDFT10;
    return back ? FFTW_RODFT01 : FFTW_RODFT10;
  }
};

bool MPMFlowFourier::is_there()
{
  return true;
}

void MPMFlowFourier::find_plans()
{
  const int last = cells.lattice.dim - 1, me = lmp->comm->me;
  int n[2];
  fftw_r2r_kind layer_kinds[2][2], line_kinds[2][2];
  for (int way = 0; way < 2; way++) {
    for (int d = 0; d < last; d++) {
      n[last - 1 - d] = axis[d].n;
      layer_kinds[way][last - 1 - d] = Transforms::kind(axis[d], way);
    }
    line_kinds[way][0] = Transforms::kind(axis[last], way);
  }
  on->layers.prepare(last, n, layers.count(me), layer_kinds);
  on->lines.prepare(1, &axis[last].n, columns.count(me), line_kinds);
}

#else

struct MPMFlowFourier::Transforms {
  struct Part {
    double *values = nullptr;
    std::size_t size = 0;
    void execute(bool) const {}
  };
  Part layers, lines;
};

bool MPMFlowFourier::is_there()
{
  return false;
}

void MPMFlowFourier::find_plans() {}

#endif

MPMFlowFourier::MPMFlowFourier(LAMMPS *lmp, const MPMFlowLattice &cells) :
    lmp(lmp), cells(cells), on(std::make_unique<Transforms>())
{
  for (auto &one : axis) one.n = 0;
}

MPMFlowFourier::~MPMFlowFourier() = default;

void MPMFlowFourier::begin()
{
  wet.clear();
  wanted.clear();
}

void MPMFlowFourier::add(const int *index, int closed, bool is_wanted)
{
  Cell cell = {{0, 0, 0}, closed};
  for (int d = 0; d < cells.lattice.dim; d++) cell.index[d] = cells.lattice.wrap(d, index[d]);
  if (is_wanted) wanted.push_back(wet.size());
  wet.push_back(cell);
}

/** The modes of an axis are those of FFTW, in its order. */
void MPMFlowFourier::Axis::find_eigenvalues()
{
  eigenvalue.resize(n);
  for (int k = 0; k < n; k++) {
    const double mode = end[0] == PERIODIC ? 2.0 * std::min(k, n - k)
        : end[0] != end[1]                 ? k + 0.5
        : end[0] == CLOSED                 ? k
                                           : k + 1.0;
    const double s = std::sin(0.5 * MY_PI * mode / n);
    eigenvalue[k] = 4.0 * s * s;
  }
}

bool MPMFlowFourier::Axis::same_transform(const Axis &other) const
{
  return n == other.n && end[0] == other.end[0] && end[1] == other.end[1];
}

/** The least number that is not less than n and has no prime factor above 31: transforms of all
 *  other lengths are slow. */
static int fast_length(int n)
{
  for (;; n++) {
    int rest = n;
    for (int factor = 2; factor <= 31; factor++)
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}

/** Finds the box around the wet cells. Is it another box than before? */
bool MPMFlowFourier::find_box()
{
  const auto &lattice = cells.lattice;
  const int dim = lattice.dim;
  int mine[6], all[6];
  std::fill_n(mine, 6, -MAXSMALLINT);
  for (const auto &cell : wet)
    for (int d = 0; d < dim; d++) {
      mine[2 * d] = std::max(mine[2 * d], -cell.index[d]);
      mine[2 * d + 1] = std::max(mine[2 * d + 1], cell.index[d]);
    }
  MPI_Allreduce(mine, all, 2 * dim, MPI_INT, MPI_MAX, lmp->world);
  if (all[0] == -MAXSMALLINT) std::fill_n(all, 6, 0);    // there is no water
  int closed[6] = {0, 0, 0, 0, 0, 0}, more_closed[6];    // cells with a wall there, less others
  for (const auto &cell : wet)
    for (int d = 0; d < dim; d++)
      for (int s = 0; s < 2; s++)
        if (cell.index[d] == (s ? all[2 * d + 1] : -all[2 * d]))
          closed[2 * d + s] += cell.closed >> (2 * d + s) & 1 ? 1 : -1;
  MPI_Allreduce(closed, more_closed, 2 * dim, MPI_INT, MPI_SUM, lmp->world);
  bool changed = false;
  for (int d = 0; d < dim; d++) {
    Axis next;
    if (lattice.periodic[d]) {
      next.first = 0;
      next.n = lattice.ncell[d];
      next.end[0] = next.end[1] = PERIODIC;
    } else {
      next.first = -all[2 * d];
      next.n = all[2 * d + 1] - next.first + 1;
      for (int s = 0; s < 2; s++) next.end[s] = more_closed[2 * d + s] > 0 ? CLOSED : OPEN;
      // air is added at an open end
      const int more = fast_length(next.n) - next.n;
      if (next.end[1] == OPEN || next.end[0] == OPEN) next.n += more;
      if (next.end[1] == CLOSED && next.end[0] == OPEN) next.first -= more;
    }
    changed = changed || !next.same_transform(axis[d]);
    if (next.same_transform(axis[d]))
      axis[d].first = next.first;
    else {
      axis[d] = next;
      axis[d].find_eigenvalues();
    }
  }
  return changed;
}

void MPMFlowFourier::Shares::divide(int n, int nranks)
{
  first.resize(nranks + 1);
  for (int rank = 0; rank <= nranks; rank++) first[rank] = (bigint) n * rank / nranks;
}

int MPMFlowFourier::Shares::has(int k) const
{
  return std::upper_bound(first.begin(), first.end(), k) - first.begin() - 1;
}

void MPMFlowFourier::Exchange::begin(int nranks)
{
  for (auto *list : {&send, &receive, &send_at, &receive_at}) list->assign(nranks, 0);
}

void MPMFlowFourier::Exchange::find_places()
{
  for (std::size_t rank = 1; rank < send.size(); rank++) {
    send_at[rank] = send_at[rank - 1] + send[rank - 1];
    receive_at[rank] = receive_at[rank - 1] + receive[rank - 1];
  }
}

/** Finds which values of cells go to which rank, and to which place in its layers. */
void MPMFlowFourier::find_exchange()
{
  const int last = cells.lattice.dim - 1, nranks = lmp->comm->nprocs, me = lmp->comm->me;
  auto &e = cell_exchange;
  e.begin(nranks);
  std::vector<int> rank_of, places;
  for (const int k : wanted) {
    int column = 0;
    for (int d = last - 1; d >= 0; d--)
      column = column * axis[d].n + wet[k].index[d] - axis[d].first;
    const int layer = wet[k].index[last] - axis[last].first, rank = layers.has(layer);
    rank_of.push_back(rank);
    places.push_back((layer - layers.first[rank]) * ncolumns + column);
    e.send[rank]++;
  }
  MPI_Alltoall(e.send.data(), 1, MPI_INT, e.receive.data(), 1, MPI_INT, lmp->world);
  e.find_places();
  std::vector<int> next = e.send_at, sent(wanted.size());
  sorted.resize(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); i++) {
    const int at = next[rank_of[i]]++;
    sorted[at] = i;
    sent[at] = places[i];
  }
  place.resize(e.all_received());
  MPI_Alltoallv(sent.data(), e.send.data(), e.send_at.data(), MPI_INT, place.data(),
                e.receive.data(), e.receive_at.data(), MPI_INT, lmp->world);

  auto &c = column_exchange;
  c.begin(nranks);
  for (int rank = 0; rank < nranks; rank++) {
    c.send[rank] = layers.count(me) * columns.count(rank);
    c.receive[rank] = layers.count(rank) * columns.count(me);
  }
  c.find_places();
}

void MPMFlowFourier::arrange(double weight)
{
  const int dim = cells.lattice.dim, nranks = lmp->comm->nprocs;
  if (find_box()) {
    bigint most = (axis[dim - 1].n + nranks - 1) / nranks;    // cells of a rank
    for (int d = 0; d < dim - 1; d++) most *= axis[d].n;
    if (most > MAXSMALLINT)
      lmp->error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/incompressible solver fourier: the box around the fluid has {} x {} x "
          "{} cells, too many for {} processes; use more of them, or solver multigrid, "
          "which has only the cells of the fluid",
          axis[0].n, axis[1].n, dim == 3 ? axis[2].n : 1, nranks);
    ncolumns = 1;
    for (int d = 0; d < dim - 1; d++) ncolumns *= axis[d].n;
    layers.divide(axis[dim - 1].n, nranks);
    columns.divide(ncolumns, nranks);
    find_plans();
  }
  find_exchange();
  int longest = 1;
  inverse = 1.0 / weight;
  for (int d = 0; d < dim; d++) {
    longest = std::max(longest, axis[d].n);
    inverse /= axis[d].end[0] == PERIODIC ? axis[d].n : 2.0 * axis[d].n;
  }
  mean_eigenvalue = MY_PI / longest * MY_PI / longest;
}

/** Sends the values outgoing to their ranks, or back: then the values incoming are sent. */
void MPMFlowFourier::swap(const Exchange &e, bool back)
{
  if (back)
    MPI_Alltoallv(incoming.data(), e.receive.data(), e.receive_at.data(), MPI_DOUBLE,
                  outgoing.data(), e.send.data(), e.send_at.data(), MPI_DOUBLE, lmp->world);
  else
    MPI_Alltoallv(outgoing.data(), e.send.data(), e.send_at.data(), MPI_DOUBLE, incoming.data(),
                  e.receive.data(), e.receive_at.data(), MPI_DOUBLE, lmp->world);
}

/** Values of layers become those of lines, or back. */
void MPMFlowFourier::to_lines(bool back)
{
  const int nranks = lmp->comm->nprocs, me = lmp->comm->me;
  const int length = layers.first[nranks], nlayers = layers.count(me), mine = columns.count(me);
  outgoing.resize(on->layers.size);
  incoming.resize(on->lines.size);
  const auto copy = [back](double &a, double &b) {
    (back ? a : b) = back ? b : a;
  };
  const auto pack = [&]() {
    double *message = outgoing.data();
    for (int rank = 0; rank < nranks; rank++)
      for (int k = 0; k < nlayers; k++) {
        double *const layer = on->layers.values + (std::size_t) k * ncolumns;
        for (int c = columns.first[rank]; c < columns.first[rank + 1]; c++)
          copy(layer[c], *message++);
      }
  };
  const auto unpack = [&]() {
    double *message = incoming.data();
    for (int k = 0; k < length; k++)
      for (int c = 0; c < mine; c++)
        copy(*message++, on->lines.values[(std::size_t) c * length + k]);
  };
  back ? unpack() : pack();
  swap(column_exchange, back);
  back ? pack() : unpack();
}

void MPMFlowFourier::divide_modes()
{
  const int last = cells.lattice.dim - 1, me = lmp->comm->me;
  const auto &along = axis[last].eigenvalue;
  double *value = on->lines.values;
  for (int c = columns.first[me]; c < columns.first[me + 1]; c++) {
    double across = axis[0].eigenvalue[c % axis[0].n];
    if (last == 2) across += axis[1].eigenvalue[c / axis[0].n];
    for (const double one : along) {
      const double sum = across + one;
      *value++ *= inverse / (sum > 0.0 ? sum : mean_eigenvalue);
    }
  }
}

void MPMFlowFourier::solve(std::vector<double> &values)
{
  outgoing.resize(cell_exchange.all_sent());
  incoming.resize(cell_exchange.all_received());
  for (std::size_t i = 0; i < sorted.size(); i++) outgoing[i] = values[sorted[i]];
  swap(cell_exchange, false);
  std::fill_n(on->layers.values, on->layers.size, 0.0);
  for (std::size_t i = 0; i < place.size(); i++) on->layers.values[place[i]] = incoming[i];
  on->layers.execute(false);
  to_lines(false);
  on->lines.execute(false);
  divide_modes();
  on->lines.execute(true);
  to_lines(true);
  on->layers.execute(true);
  outgoing.resize(cell_exchange.all_sent());
  incoming.resize(cell_exchange.all_received());
  for (std::size_t i = 0; i < place.size(); i++) incoming[i] = on->layers.values[place[i]];
  swap(cell_exchange, true);
  for (std::size_t i = 0; i < sorted.size(); i++) values[sorted[i]] = outgoing[i];
}

double MPMFlowFourier::memory_usage() const
{
  double reals =
      (double) on->layers.size + on->lines.size + outgoing.capacity() + incoming.capacity();
  for (const auto &one : axis) reals += one.eigenvalue.capacity();
  return reals * sizeof(double) + wet.capacity() * sizeof(Cell) +
      (wanted.capacity() + sorted.capacity() + place.capacity()) * sizeof(int);
}
