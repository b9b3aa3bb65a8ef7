/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/mpm_ties.h"

#include "field/mpm_node_system.h"
#include "field/mpm_trial_contact.h"

#include "comm.h"
#include "error.h"

#include <algorithm>
#include <cmath>
#include <map>

using namespace LAMMPS_NS;

static constexpr double FREE = 1.0e-12;       // change of a velocity by walls that do not act there
static constexpr double NOTHING = 1.0e-13;    // entry of a column, of its largest
static constexpr double TIED = 1.0e-14;       // what is left of the approach of bodies that touch
static constexpr int MOST_ROUNDS = 6;
// of the diagonal, the first one with which there are factors: walls can make rows depend on each
// other
static constexpr double LIFTS[] = {0.0, 1.0e-13, 1.0e-11, 1.0e-9};

/** Numbers on all ranks of the rows that this one knows, and which of them have nodes on which
 *  walls act. Collective. */
void MPMTies::number_rows(std::vector<char> &walled, const std::vector<char> &is_free)
{
  const int size = contact->rows_of_group();
  const std::size_t ngroups = contact->nrows() / size;
  using Key = MPMBodyContact::Key;
  constexpr int NKEY = (int) std::tuple_size<Key>::value;
  std::vector<int> mine;
  for (std::size_t g = 0; g < ngroups; g++) {
    if (!contact->owns(g)) continue;
    const Key key = contact->key_of(g);
    mine.insert(mine.end(), key.begin(), key.end());
    bool touched = false;
    for (int r = 0; r < size; r++)
      contact->visit_row(g * size + r, [&](int64_t k, double) {
        touched = touched || !is_free[k];
      });
    mine.push_back(touched);
  }
  std::vector<int> counts(comm->nprocs), begins(comm->nprocs, 0);
  const int count = (int) mine.size();
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int k = 1; k < comm->nprocs; k++) begins[k] = begins[k - 1] + counts[k - 1];
  std::vector<int> keys(begins.back() + counts.back());
  MPI_Allgatherv(mine.data(), count, MPI_INT, keys.data(), counts.data(), begins.data(), MPI_INT,
                 world);
  const int ngroups_everywhere = (int) keys.size() / (NKEY + 1);
  all = ngroups_everywhere * size;
  walled.assign(all, 0);
  std::map<Key, int> numbers;
  for (int g = 0; g < ngroups_everywhere; g++) {
    const int *const from = &keys[(std::size_t) g * (NKEY + 1)];
    Key key;
    std::copy_n(from, NKEY, key.begin());
    numbers[key] = g;
    std::fill_n(walled.begin() + g * size, size, (char) from[NKEY]);
  }
  global.assign(contact->nrows(), -1);
  for (std::size_t g = 0; g < ngroups; g++)
    if (const auto found = numbers.find(contact->key_of(g)); found != numbers.end())
      for (int r = 0; r < size; r++) global[g * size + r] = found->second * size + r;
}

void MPMTies::begin(MPMBodyContact &of, const std::vector<double> &mass, int width, int acts,
                    bool has_walls, const std::function<void(double *)> &walls)
{
  contact = &of;
  with_acts = acts;
  const std::size_t n = mass.size() * width;

  // where walls leave a motion that is no special one as it is, they also do nothing with one that
  // is there alone, as P_w is symmetric

  std::vector<char> is_free(n, 1), walled;
  if (has_walls) {
    std::vector<double> v(n), moved;
    for (std::size_t k = 0; k < n; k++)
      v[k] = mass[k / width] > 0.0 ? 1.5 + std::sin(1.0 + 7.3 * (double) k) : 0.0;
    moved = v;
    walls(moved.data());
    for (std::size_t k = 0; k < n; k++) is_free[k] = std::fabs(moved[k] - v[k]) <= FREE;
  }
  number_rows(walled, is_free);

  columns.assign(all, {});
  std::vector<int> local(all, -1);
  for (std::size_t row = 0; row < global.size(); row++)
    if (global[row] >= 0) local[global[row]] = (int) row;
  std::vector<double> v(n);
  for (int number = 0; number < all; number++) {
    std::vector<Entry> &column = columns[number];
    if (local[number] >= 0)
      contact->visit_row(local[number], [&](int64_t k, double c) {
        if (c != 0.0) column.push_back({k, c / mass[k / width]});
      });
    if (!walled[number]) continue;
    std::fill(v.begin(), v.end(), 0.0);
    double most = 0.0;
    for (const Entry &entry : column) {
      v[entry.k] += entry.value;
      most = std::max(most, std::fabs(entry.value));
    }
    walls(v.data());
    double largest;
    MPI_Allreduce(&most, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
    column.clear();
    for (std::size_t k = 0; k < n; k++)
      if (std::fabs(v[k]) > NOTHING * largest) column.push_back({(int64_t) k, v[k]});
  }
  find_products();
}

/** S = C Z of all rows, from those that this rank owns. Collective. */
void MPMTies::find_products()
{
  const int size = contact->rows_of_group();
  std::map<int64_t, std::vector<std::pair<int, double>>> at;    // entries of columns
  for (std::size_t row = 0; row < global.size(); row++)
    if (contact->owns(row / size))
      contact->visit_row(row, [&](int64_t k, double) {
        at[k];
      });
  for (int number = 0; number < all; number++)
    for (const Entry &entry : columns[number])
      if (const auto found = at.find(entry.k); found != at.end())
        found->second.emplace_back(number, entry.value);
  std::vector<double> mine;
  for (std::size_t row = 0; row < global.size(); row++) {
    if (!contact->owns(row / size)) continue;
    std::map<int, double> products;
    contact->visit_row(row, [&](int64_t k, double c) {
      for (const auto &[number, value] : at[k]) products[number] += c * value;
    });
    for (const auto &[number, value] : products)
      mine.insert(mine.end(), {(double) global[row], (double) number, value});
  }
  std::vector<int> counts(comm->nprocs), begins(comm->nprocs, 0);
  const int count = (int) mine.size();
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int k = 1; k < comm->nprocs; k++) begins[k] = begins[k - 1] + counts[k - 1];
  std::vector<double> list(begins.back() + counts.back());
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, list.data(), counts.data(), begins.data(),
                 MPI_DOUBLE, world);
  S.clear();
  for (std::size_t k = 0; k < list.size(); k += 3)
    S.emplace_back((int) list[k], (int) list[k + 1], list[k + 2]);
}

void MPMTies::factorize()
{
  const int size = contact->rows_of_group();
  std::vector<int> mine(all, 0), holds(all);
  for (std::size_t row = 0; row < global.size(); row++)
    if (contact->owns(row / size) && contact->holds(row)) mine[global[row]] = 1;
  MPI_Allreduce(mine.data(), holds.data(), all, MPI_INT, MPI_MAX, world);
  place.assign(all, -1);
  int n = 0;
  for (int number = 0; number < all; number++)
    if (holds[number]) place[number] = n++;
  for (const double lift : LIFTS) {
    std::vector<Eigen::Triplet<double>> list;
    for (const auto &entry : S) {
      const int i = place[entry.row()], j = place[entry.col()];
      if (i < 0 || j < 0) continue;
      const double half = 0.5 * entry.value() * (i == j ? 1.0 + lift : 1.0);
      list.emplace_back(i, j, half);
      list.emplace_back(j, i, half);
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(list.begin(), list.end());
    if (factors.compute(matrix)) return;
  }
  error->all(
      FLERR, Error::NOLASTLINE,
      "Fix mpm/implicit: {} conditions of bodies that touch contradict each other or are not "
      "finite: look for points that have been lost or pressed flat, or use smaller steps",
      n);
}

void MPMTies::close(double *v)
{
  const int size = contact->rows_of_group(), n = factors.size();
  double enough = 0.0, before = 0.0;
  for (int round = 0; round < MOST_ROUNDS; round++) {
    rows.assign(contact->nrows(), 0.0);
    contact->find_approach(v, true, rows.data());
    double part[2], squares[2];
    contact->add_squares(rows.data(), round == 0 ? v : nullptr, part);
    sum_in_order(lmp, 2, part, gathered, squares);
    if (round == 0) enough = TIED * TIED * squares[1];
    // rounding errors are all that is left
    if (!(squares[0] > enough) || (round > 1 && squares[0] > 0.5 * before)) return;
    before = squares[0];
    mine.assign(n, 0.0);
    for (std::size_t row = 0; row < rows.size(); row++)
      if (contact->owns(row / size) && global[row] >= 0 && place[global[row]] >= 0)
        mine[place[global[row]]] = rows[row];
    sums.resize(n);
    impulse.resize(n);
    MPI_Allreduce(mine.data(), sums.data(), n, MPI_DOUBLE, MPI_SUM, world);
    factors.solve(sums.data(), impulse.data());
    for (int number = 0; number < all; number++) {
      if (place[number] < 0) continue;
      const double row_impulse = impulse[place[number]];
      for (const Entry &entry : columns[number]) v[entry.k] -= row_impulse * entry.value;
    }
    std::fill(rows.begin(), rows.end(), 0.0);
    for (std::size_t row = 0; row < rows.size(); row++)
      if (global[row] >= 0 && place[global[row]] >= 0) rows[row] = impulse[place[global[row]]];
    contact->push(1.0, rows.data());
  }
}
