/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/cell_multigrid.h"

#include "math/sets.h"
#include "solve/rim_factors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>
#include <utility>

using namespace MPM_NS;

// cells of a level that is factorized, and sweeps of Gauss-Seidel before and after a coarse
// correction
static constexpr int FEW = 400;
static constexpr int SWEEPS = 1;
// corrections by the next level, from the second level on
static constexpr int CORRECTIONS = 2;
// of the coefficients of joined cells: the faces of a level twice as coarse have twice the distance
// between cells
static constexpr double COARSER = 0.5;

namespace {

/** Cells that faces join within a larger cell. */
struct Piece {
  uint64_t key;      // of the larger cell
  uint64_t cells;    // bits of its cells
};
struct Flow {    // between two pieces, or out of one of them
  int a, b;
  double value;
};

int bit_of(const int *index)
{
  return (index[0] & 1) << 2 | (index[1] & 1) << 1 | (index[2] & 1);
}

/** Cells of a level, and its cells by larger ones. */
class Pieces {
 public:
  std::vector<int> piece;    // [cell]
  std::vector<Piece> all;

  /** split: several cells of one place are not the same, but pieces of it that are not joined. */
  Pieces(const CellGraph &graph, int64_t vector_size, bool split)
  {
    const int n = graph.size();
    cell_at.assign(vector_size, -1);
    for (int cell = 0; cell < n; cell++) cell_at[graph.where[cell]] = cell;
    std::vector<uint64_t> key(n);
    std::vector<int> order(n);
    Sets joined(n);
    for (int cell = 0; cell < n; cell++) {
      const int *const index = graph.index.data() + 3 * cell;
      key[cell] = lattice_key({index[0] >> 1, index[1] >> 1, index[2] >> 1});
    }
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return key[a] < key[b] || (key[a] == key[b] && a < b);
    });
    piece.resize(n);
    for (int i = 0, j; i < n; i = j) {
      int same[8];
      std::fill_n(same, 8, -1);
      for (j = i; j < n && key[order[j]] == key[order[i]]; j++) {
        const int cell = order[j];
        for (int k = graph.first[cell]; k < graph.first[cell + 1]; k++) {
          const int other = cell_at[graph.neighbor[k]];
          if (key[other] == key[cell]) joined.join(cell, other);
        }
        int &known = same[bit_of(graph.index.data() + 3 * cell)];
        if (!split && known >= 0) joined.join(cell, known);
        known = cell;
      }
      for (int k = i; k < j; k++) {
        const int root = joined.root(order[k]);
        if (root == order[k]) {
          piece[root] = all.size();
          all.push_back({key[root], 0});
        }
      }
      for (int k = i; k < j; k++) {
        const int cell = order[k];
        piece[cell] = piece[joined.root(cell)];
        all[piece[cell]].cells |= uint64_t(1) << bit_of(graph.index.data() + 3 * cell);
      }
    }
  }

  int at(int64_t place) const { return piece[cell_at[place]]; }

 private:
  std::vector<int> cell_at;    // [place in vectors]
};

/** By a < n, then by b: of each a there are a few. Equal ones stay in their order, so that sums of
 *  these do not change. */
void put_in_order(std::vector<Flow> &flows, int n)
{
  std::vector<int> end(n + 1, 0);
  for (const auto &flow : flows) end[flow.a + 1]++;
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Flow> ordered(flows.size());
  const std::vector<int> first = end;
  for (const auto &flow : flows) {
    int place = end[flow.a]++;
    for (; place > first[flow.a] && ordered[place - 1].b > flow.b; place--)
      ordered[place] = ordered[place - 1];
    ordered[place] = flow;
  }
  flows.swap(ordered);
}

/** The next level, from what flows between its cells. */
CellGraph coarse_graph(const std::vector<Piece> &pieces, std::vector<Flow> &flows)
{
  CellGraph graph;
  const int n = pieces.size();
  put_in_order(flows, n);
  graph.outside.assign(n, 0.0);
  graph.inverse.assign(n, 0.0);
  graph.where.resize(n);
  std::iota(graph.where.begin(), graph.where.end(), 0);
  graph.first.push_back(0);
  std::size_t k = 0;
  for (int cell = 0; cell < n; cell++) {
    for (const int i : lattice_index(pieces[cell].key)) graph.index.push_back(i);
    while (k < flows.size() && flows[k].a == cell) {
      double sum = 0.0;
      const int other = flows[k].b;
      for (; k < flows.size() && flows[k].a == cell && flows[k].b == other; k++)
        sum += flows[k].value;
      if (other < 0)
        graph.outside[cell] = COARSER * sum;
      else {
        graph.neighbor.push_back(other);
        graph.face.push_back(COARSER * sum);
      }
    }
    graph.first.push_back(graph.neighbor.size());
    const double diagonal = graph.diagonal(cell);
    if (diagonal > 0.0) graph.inverse[cell] = 1.0 / diagonal;
  }
  graph.color();
  return graph;
}

/** Sums over the neighbors of cells, color by color, with as many places for each cell: what sweeps
 *  do most of the time. */
class ColoredSums {
 public:
  /** Of a graph whose places in vectors are its cells. */
  void setup(const CellGraph &graph)
  {
    width = 0;
    for (int cell = 0; cell < graph.size(); cell++)
      width = std::max(width, graph.first[cell + 1] - graph.first[cell]);
    width = width <= 4 ? 4 : width <= 6 ? 6 : width;
    for (int color = 0; color < 2; color++) {
      auto &of = colors[color];
      of.cell = graph.colored[color];
      of.neighbor.assign(of.cell.size() * width, 0);
      of.face.assign(of.cell.size() * width, 0.0);
      for (std::size_t i = 0; i < of.cell.size(); i++) {
        const int first = graph.first[of.cell[i]], last = graph.first[of.cell[i] + 1];
        std::copy(graph.neighbor.begin() + first, graph.neighbor.begin() + last,
                  of.neighbor.begin() + i * width);
        std::copy(graph.face.begin() + first, graph.face.begin() + last,
                  of.face.begin() + i * width);
      }
    }
  }
  /** put(cell, sum of face times x of its neighbors) for the cells of a color, one after the
   *  other. */
  template <class Put> void visit(int color, const double *x, const Put &put) const
  {
    if (width == 4)
      visit_all(colors[color], x, put, std::integral_constant<int, 4>());
    else if (width == 6)
      visit_all(colors[color], x, put, std::integral_constant<int, 6>());
    else
      visit_all(colors[color], x, put, width);
  }
  double memory_usage() const
  {
    double bytes = 0.0;
    for (const auto &of : colors) bytes += bytes_of(of.cell, of.neighbor, of.face);
    return bytes;
  }

 private:
  struct Color {
    std::vector<int> cell, neighbor;
    std::vector<double> face;
  };
  Color colors[2];
  int width = 0;

  template <class Put, class Width>
  static void visit_all(const Color &of, const double *x, const Put &put, const Width &width)
  {
    const int *other = of.neighbor.data();
    const double *face = of.face.data();
    for (const int cell : of.cell) {
      double sum = 0.0;
      for (int k = 0; k < width; k++) sum += face[k] * x[other[k]];
      other += width;
      face += width;
      put(cell, sum);
    }
  }
};

/** What flows between pieces: to b = -1, to the outside. */
std::vector<Flow> coarse_flows(const CellGraph &graph, const Pieces &pieces,
                               const std::vector<int> &number)
{
  std::vector<Flow> flows;
  for (int cell = 0; cell < graph.size(); cell++) {
    const int a = number[pieces.piece[cell]];
    if (graph.outside[cell] > 0.0) flows.push_back({a, -1, graph.outside[cell]});
    for (int k = graph.first[cell]; k < graph.first[cell + 1]; k++) {
      const int b = number[pieces.at(graph.neighbor[k])];
      if (a != b) flows.push_back({a, b, graph.face[k]});
    }
  }
  return flows;
}

}    // namespace

/* ---------------------------------------------------------------------- */

struct CellMultigrid::Levels {
  const CellOperator *fine = nullptr;

  // from the finest level, of which this rank has a part, to the first one that all have
  std::vector<int> piece;          // [cell] the part of this rank of a coarse cell
  std::vector<int> number;         // [piece] the coarse cell
  std::vector<int> all_numbers;    // coarse cells of the pieces of all ranks, rank by rank
  std::vector<double> partial, gathered, node_values;

  // the same for cells that this rank owns
  std::vector<int> part;           // [place in vectors]
  std::vector<int> part_number;    // [part] the coarse cell
  std::vector<int> part_numbers, part_bytes;

  struct Level {
    CellGraph graph;
    ColoredSums sums;
    std::vector<int> next;    // [cell] of the next level
    std::vector<double> x, b, diagonal, to_be;
    bool proper = false;    // neighbors have different colors
  };
  std::vector<Level> coarse;
  EnvelopeFactors factors;
  bool usable = true;    // these are factors

  // closed pools
  std::vector<int> pool;    // [cell of the first coarse level], -1: not closed
  std::vector<double> cells_of_pool;

  void first_coarse();
  void find_parts();
  void more_levels();
  void factorize();
  void find_pools(const std::vector<int> &component, const std::vector<char> &closed);

  void smooth_fine(const double *r, double *z, bool from_zero, bool backwards);
  void restrict_fine(const double *r, const double *z);
  void cycle(std::size_t level);
  template <class Number> void means(const Number &value, std::vector<double> &mean);
};

CellMultigrid::CellMultigrid() : on(new Levels) {}
CellMultigrid::~CellMultigrid() = default;

void CellMultigrid::setup(const CellOperator &fine)
{
  on.reset(new Levels);
  on->fine = &fine;
  on->node_values.resize(fine.grid.nnodes());
  on->first_coarse();
  on->more_levels();
  on->factorize();
}

/** Pieces of larger cells are joined where ranks have the same cell in theirs; all ranks get all of
 *  them. */
void CellMultigrid::Levels::first_coarse()
{
  const auto &graph = fine->cells();
  Pieces mine(graph, fine->grid.nnodes(), false);
  auto pieces = fine->ranks.gather(mine.all);
  std::sort(pieces.begin(), pieces.end(), [](const Piece &a, const Piece &b) {
    return a.key < b.key || (a.key == b.key && a.cells < b.cells);
  });
  std::vector<Piece> joined;
  std::size_t begin = 0;    // of those of the same cell
  for (const auto &next : pieces) {
    if (!joined.empty() && joined.back().key != next.key) begin = joined.size();
    Piece whole = next;
    for (std::size_t k = begin; k < joined.size();)
      if (joined[k].cells & whole.cells) {
        whole.cells |= joined[k].cells;
        joined.erase(joined.begin() + k);
      } else
        k++;
    joined.push_back(whole);
  }

  number.resize(mine.all.size());
  for (std::size_t k = 0; k < number.size(); k++) {
    const auto &piece = mine.all[k];
    auto found =
        std::lower_bound(joined.begin(), joined.end(), piece.key, [](const Piece &a, uint64_t key) {
          return a.key < key;
        });
    while (!(found->cells & piece.cells)) ++found;
    number[k] = found - joined.begin();
  }
  piece = mine.piece;
  all_numbers = fine->ranks.gather(number);
  auto flows = fine->ranks.gather(coarse_flows(graph, mine, number));
  coarse.emplace_back();
  coarse[0].graph = coarse_graph(joined, flows);
  find_parts();
}

void CellMultigrid::Levels::find_parts()
{
  const auto &graph = fine->cells();
  std::vector<int> of_piece(number.size(), -1);
  part.assign(fine->grid.nnodes(), -1);
  part_number.clear();
  for (int cell = 0; cell < graph.size(); cell++) {
    if (!fine->grid.owns(graph.where[cell])) continue;
    int &which = of_piece[piece[cell]];
    if (which < 0) {
      which = part_number.size();
      part_number.push_back(number[piece[cell]]);
    }
    part[graph.where[cell]] = which;
  }
  const std::vector<int> bytes(1, (int) (part_number.size() * sizeof(double)));
  part_bytes = fine->ranks.gather(bytes);
  part_numbers = fine->ranks.gather(part_number);
}

void CellMultigrid::Levels::more_levels()
{
  while (true) {
    auto &level = coarse.back();
    const int n = level.graph.size();
    for (auto *vector : {&level.x, &level.b}) vector->resize(n);
    if (n <= FEW || level.graph.neighbor.empty()) break;
    level.proper = level.graph.is_proper();
    if (!level.proper) level.to_be.resize(n);
    level.sums.setup(level.graph);
    for (int cell = 0; cell < n; cell++) level.diagonal.push_back(level.graph.diagonal(cell));
    Pieces pieces(level.graph, n, true);
    std::vector<int> same(pieces.all.size());
    std::iota(same.begin(), same.end(), 0);
    level.next = pieces.piece;
    auto flows = coarse_flows(level.graph, pieces, same);
    Level next;
    next.graph = coarse_graph(pieces.all, flows);
    coarse.push_back(std::move(next));
  }
}

/** Of a closed pool one cell is held: what this adds to a solution is a constant. */
void CellMultigrid::Levels::factorize()
{
  const auto &graph = coarse.back().graph;
  const int n = graph.size();
  Sets pools(n);
  for (int cell = 0; cell < n; cell++)
    for (int k = graph.first[cell]; k < graph.first[cell + 1]; k++)
      pools.join(cell, graph.neighbor[k]);
  std::vector<int> component(n);
  std::vector<char> closed(n, 1);
  for (int cell = 0; cell < n; cell++) {
    component[cell] = pools.root(cell);
    if (graph.outside[cell] > 0.0) closed[component[cell]] = 0;
  }

  std::vector<Eigen::Triplet<double>> entries;
  for (int cell = 0; cell < n; cell++) {
    double diagonal = graph.diagonal(cell);
    if (component[cell] == cell && closed[cell]) diagonal += diagonal > 0.0 ? diagonal : 1.0;
    entries.emplace_back(cell, cell, diagonal);
    for (int k = graph.first[cell]; k < graph.first[cell + 1]; k++)
      entries.emplace_back(cell, (int) graph.neighbor[k], -graph.face[k]);
  }
  Eigen::SparseMatrix<double> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  usable = factors.compute(A);
  find_pools(component, closed);
}

void CellMultigrid::Levels::find_pools(const std::vector<int> &component,
                                       const std::vector<char> &closed)
{
  const int n = component.size();
  std::vector<int> number_of(n, -1);
  int npools = 0;
  for (int cell = 0; cell < n; cell++)
    if (component[cell] == cell && closed[cell]) number_of[cell] = npools++;
  pool.clear();
  if (npools == 0) return;
  pool.resize(n);
  for (int cell = 0; cell < n; cell++) pool[cell] = number_of[component[cell]];
  for (std::size_t level = coarse.size() - 1; level-- > 0;) {
    std::vector<int> finer(coarse[level].next.size());
    for (std::size_t cell = 0; cell < finer.size(); cell++)
      finer[cell] = pool[coarse[level].next[cell]];
    pool.swap(finer);
  }
  cells_of_pool.assign(npools, 1.0);
  std::vector<double> cells;
  means(
      [](int64_t) {
        return 1.0;
      },
      cells);
  cells_of_pool = cells;
}

/** [pool] sums of value(place in vectors) over all ranks and over the number of cells. */
template <class Number>
void CellMultigrid::Levels::means(const Number &value, std::vector<double> &mean)
{
  const auto &graph = fine->cells();
  const std::size_t npools = cells_of_pool.size();
  std::vector<double> mine(npools, 0.0);
  for (int cell = 0; cell < graph.size(); cell++) {
    const int which = pool[number[piece[cell]]];
    if (which >= 0 && fine->grid.owns(graph.where[cell])) mine[which] += value(graph.where[cell]);
  }
  fine->ranks.gather(mine, gathered);
  mean.assign(npools, 0.0);
  for (std::size_t k = 0; k < gathered.size(); k++) mean[k % npools] += gathered[k];
  for (std::size_t k = 0; k < npools; k++) mean[k] /= cells_of_pool[k];
}

double CellMultigrid::project(double *x)
{
  const auto &graph = on->fine->cells();
  double largest = 0.0;
  std::vector<double> mean;
  if (!on->pool.empty())
    on->means(
        [&](int64_t place) {
          return x[place];
        },
        mean);
  for (const double m : mean) largest = std::max(largest, std::fabs(m));

  auto &kept = on->node_values;
  std::fill(kept.begin(), kept.end(), 0.0);
  for (int cell = 0; cell < graph.size(); cell++) {
    const int64_t place = graph.where[cell];
    const int which = mean.empty() ? -1 : on->pool[on->number[on->piece[cell]]];
    kept[place] = x[place] - (which < 0 ? 0.0 : mean[which]);
  }
  std::copy(kept.begin(), kept.end(), x);
  return largest;
}

/** A sweep over both colors. With values of all ranks at both sides of faces, all cells of a color
 *  change at once. */
void CellMultigrid::Levels::smooth_fine(const double *r, double *z, bool from_zero, bool backwards)
{
  const auto &graph = fine->cells();
  for (int half = 0; half < 2; half++) {
    const auto &cells = graph.colored[backwards ? 1 - half : half];
    if (from_zero && half == 0) {
      for (const int cell : cells)
        z[graph.where[cell]] = graph.inverse[cell] * r[graph.where[cell]];
      continue;
    }
    std::fill(node_values.begin(), node_values.end(), 0.0);
    for (const int cell : cells) node_values[graph.where[cell]] = graph.flow(cell, z);
    fine->ranks.sum(node_values.data(), 1);
    for (const int cell : cells) {
      const int64_t place = graph.where[cell];
      z[place] += graph.inverse[cell] * (r[place] - node_values[place]);
    }
  }
}

/** Right side of the first coarse level: each rank has a part of the residuals of its cells, that
 *  of r where it owns them. */
void CellMultigrid::Levels::restrict_fine(const double *r, const double *z)
{
  const auto &graph = fine->cells();
  partial.assign(number.size(), 0.0);
  for (int cell = 0; cell < graph.size(); cell++) {
    const int64_t place = graph.where[cell];
    partial[piece[cell]] += (fine->grid.owns(place) ? r[place] : 0.0) - graph.flow(cell, z);
  }
  fine->ranks.gather(partial, gathered);
  auto &b = coarse[0].b;
  std::fill(b.begin(), b.end(), 0.0);
  for (std::size_t k = 0; k < gathered.size(); k++) b[all_numbers[k]] += gathered[k];
}

/** x of a coarse level from its b. */
void CellMultigrid::Levels::cycle(std::size_t which)
{
  auto &level = coarse[which];
  const auto &graph = level.graph;
  if (which + 1 == coarse.size()) {
    if (usable)
      factors.solve(level.b.data(), level.x.data());
    else
      std::fill(level.x.begin(), level.x.end(), 0.0);
    return;
  }

  // a color whose neighbors have changed has no residual after its sweep, if no two of its cells
  // are neighbors: another sweep of it changes nothing, and what it was before does not matter

  double *const x = level.x.data();
  const double *const b = level.b.data(), *const diagonal = level.diagonal.data(),
                      *const inverse = graph.inverse.data();
  const int colors = level.proper ? 1 : 2;    // with a residual
  // in no order within a color: symmetric
  double *const to_be = level.proper ? x : level.to_be.data();
  const auto sweep = [&](int color) {
    level.sums.visit(color, x, [=](int cell, double sum) {
      to_be[cell] = inverse[cell] * (b[cell] + sum);
    });
    if (to_be != x)
      for (const int cell : graph.colored[color]) x[cell] = to_be[cell];
  };
  std::fill(level.x.begin(), level.x.end(), 0.0);
  for (int correction = 0; correction < CORRECTIONS; correction++) {
    for (int s = 0; s < SWEEPS; s++) {
      if (correction == 0 || s > 0 || !level.proper) sweep(0);
      sweep(1);
    }
    auto &next = coarse[which + 1];
    double *const next_b = next.b.data();
    const double *const next_x = next.x.data();
    const int *const to = level.next.data();
    std::fill(next.b.begin(), next.b.end(), 0.0);
    for (int color = 0; color < colors; color++)
      level.sums.visit(color, x, [=](int cell, double sum) {
        next_b[to[cell]] += b[cell] + sum - diagonal[cell] * x[cell];
      });
    cycle(which + 1);
    for (int color = 0; color < colors; color++)
      for (const int cell : graph.colored[color]) x[cell] += next_x[to[cell]];
    for (int s = 0; s < SWEEPS; s++) {
      sweep(1);
      sweep(0);
    }
  }
}

int CellMultigrid::parts() const
{
  return on->part_number.size();
}

int CellMultigrid::part_of(int64_t place) const
{
  return on->part[place];
}

void CellMultigrid::correct(std::vector<double> &parts)
{
  const auto &bytes = on->fine->ranks.gather_sizes(parts.data(), on->part_bytes);
  on->gathered.resize(on->part_numbers.size());
  if (!bytes.empty()) std::memcpy(on->gathered.data(), bytes.data(), bytes.size());
  auto &first = on->coarse[0];
  std::fill(first.b.begin(), first.b.end(), 0.0);
  for (std::size_t k = 0; k < on->gathered.size(); k++)
    first.b[on->part_numbers[k]] += on->gathered[k];
  on->cycle(0);
  for (std::size_t k = 0; k < parts.size(); k++) parts[k] = first.x[on->part_number[k]];
}

void CellMultigrid::precondition(const double *r, double *z)
{
  const auto &graph = on->fine->cells();
  std::fill_n(z, on->fine->grid.nnodes(), 0.0);
  for (int s = 0; s < SWEEPS; s++) on->smooth_fine(r, z, s == 0, false);
  on->restrict_fine(r, z);
  on->cycle(0);
  for (int cell = 0; cell < graph.size(); cell++)
    z[graph.where[cell]] += on->coarse[0].x[on->number[on->piece[cell]]];
  for (int s = 0; s < SWEEPS; s++) on->smooth_fine(r, z, false, true);
  if (!on->pool.empty()) project(z);
}

bool CellMultigrid::usable() const
{
  return on->usable;
}

int CellMultigrid::closed_pools() const
{
  return on->pool.empty() ? 0 : on->cells_of_pool.size();
}

int CellMultigrid::levels() const
{
  return 1 + on->coarse.size();
}

double CellMultigrid::memory_usage() const
{
  double bytes =
      bytes_of(on->piece, on->number, on->all_numbers, on->pool, on->part, on->part_number,
               on->part_numbers, on->partial, on->gathered, on->node_values, on->cells_of_pool) +
      on->factors.memory_usage();
  for (const auto &level : on->coarse)
    bytes += level.graph.memory_usage() + level.sums.memory_usage() +
        bytes_of(level.next, level.x, level.b, level.diagonal, level.to_be);
  return bytes;
}
