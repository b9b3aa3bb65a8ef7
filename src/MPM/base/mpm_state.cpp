/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "base/mpm_state.h"

#include "atom.h"
#include "error.h"
#include "lammps.h"
#include "memory.h"
#include "update.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

using namespace LAMMPS_NS;

MPMPointState::~MPMPointState()
{
  for (auto &array : arrays) {
    array.mine.grown(memory, 0, array.width, array.name);
    memory->sfree(array.pointers);
  }
}

void MPMPointState::declare(MPMRows &rows, const char *name, int width, Fresh fresh)
{
  rows = MPMRows();
  arrays.push_back({&rows, nullptr, nullptr, rows, nullptr, name, width, std::move(fresh)});
}

void MPMPointState::declare(double **&table, const char *name, int width, Fresh fresh)
{
  table = nullptr;
  arrays.push_back({nullptr, &table, nullptr, MPMRows(), nullptr, name, width, std::move(fresh)});
}

void MPMPointState::declare(double *&values, const char *name, Fresh fresh)
{
  values = nullptr;
  arrays.push_back({nullptr, nullptr, &values, MPMRows(), nullptr, name, 1, std::move(fresh)});
}

int MPMPointState::size() const
{
  int sum = 0;
  for (const auto &array : arrays) sum += array.width;
  return sum;
}

std::string MPMPointState::layout() const
{
  std::string text;
  for (const auto &array : arrays)
    text +=
        (text.empty() ? "" : ", ") + std::string(array.name) + " " + std::to_string(array.width);
  return text;
}

void MPMPointState::grow(int nmax)
{
  for (auto &array : arrays) {
    array.mine = array.mine.grown(memory, nmax, array.width, array.name);
    if (array.rows) *array.rows = array.mine;
    if (array.values) *array.values = array.mine[0];
    if (!array.table) continue;
    array.pointers =
        (double **) memory->srealloc(array.pointers, (bigint) sizeof(double *) * nmax, array.name);
    for (int i = 0; i < nmax; i++) array.pointers[i] = array.mine[i];
    *array.table = array.pointers;
  }
}

void MPMPointState::copy(int from, int to)
{
  for (auto &array : arrays) std::copy_n(array.mine[from], array.width, array.mine[to]);
}

void MPMPointState::fresh(int i)
{
  for (auto &array : arrays) {
    double *const row = array.mine[i];
    std::fill_n(row, array.width, 0.0);
    if (array.fresh) array.fresh(i, row);
  }
}

int MPMPointState::pack(int i, double *buf) const
{
  for (const auto &array : arrays) buf = std::copy_n(array.mine[i], array.width, buf);
  return size();
}

int MPMPointState::unpack(int i, const double *buf)
{
  for (auto &array : arrays) {
    std::copy_n(buf, array.width, array.mine[i]);
    buf += array.width;
  }
  return size();
}

FixMPMState::~FixMPMState()
{
  if (!callbacks || !modify) return;
  atom->delete_callback(id, Atom::GROW);
  if (restarts) atom->delete_callback(id, Atom::RESTART);
}

void FixMPMState::keep_arrays(bool in_restart_files)
{
  if (state.empty()) return;
  state.grow(atom->nmax);
  // may end with an error; then there must be no callbacks to a fix that does not exist
  for (int i = 0; i < atom->nlocal; i++) state.fresh(i);
  callbacks = true;
  restarts = in_restart_files;
  atom->add_callback(Atom::GROW);
  if (restarts) atom->add_callback(Atom::RESTART);
  restart_peratom = restarts;
  create_attribute = 1;
  maxexchange = state.size();
}

double FixMPMState::memory_usage()
{
  return (double) state.size() * atom->nmax * sizeof(double);
}

int FixMPMState::pack_restart(int i, double *buf)
{
  buf[0] = 1 + pack_exchange(i, buf + 1);
  return (int) buf[0];
}

const double *FixMPMState::from_restart(int i, int nth, int &n) const
{
  const double *extra = atom->extra[i];
  for (int k = 0; k < nth; k++) extra += (int) *extra;
  n = (int) *extra - 1;
  return extra + 1;
}

void FixMPMState::unpack_restart(int i, int nth)
{
  int n;
  const double *values = from_restart(i, nth, n);
  if (n != state.size()) {
    const auto layout = state.layout();
    error->one(FLERR, Error::NOLASTLINE,
               "The restart file has {} numbers per point for fix {} (style {}), not {}{}: give "
               "the fix the options with which the file was written",
               n, id, style, state.size(), layout.empty() ? "" : " (" + layout + ")");
  }
  state.unpack(i, values);
}

void LAMMPS_NS::keep_totals(MPI_Comm world, double *values, int n)
{
  std::vector<double> total(n, 0.0);
  MPI_Reduce(values, total.data(), n, MPI_DOUBLE, MPI_SUM, 0, world);
  std::copy(total.begin(), total.end(), values);
}

void LAMMPS_NS::write_totals(FILE *fp, MPI_Comm world, std::vector<double> &totals,
                             const std::vector<double> &same)
{
  keep_totals(world, totals.data(), (int) totals.size());
  int me;
  MPI_Comm_rank(world, &me);
  if (me) return;
  std::vector<double> all = totals;
  all.insert(all.end(), same.begin(), same.end());
  write_state(fp, all.data(), all.size() * sizeof(double));
}

double LAMMPS_NS::checksum(const void *bytes, std::size_t size)
{
  constexpr int BITS = 53;    // of an integer in a real
  uint64_t sum = 14695981039346656037ULL;
  for (std::size_t i = 0; i < size; i++)
    sum = (sum ^ ((const unsigned char *) bytes)[i]) * 1099511628211ULL;
  return (double) (sum >> (64 - BITS) ^ (sum & 0x7ff));
}

namespace {
/** Before a state: its size twice, so that a damaged one is seen before it is used. */
struct StateHeader {
  double size, minus_size, checksum;
};
}    // namespace

void LAMMPS_NS::write_state(FILE *fp, const void *state, std::size_t size)
{
  const StateHeader header = {(double) size, -(double) size, checksum(state, size)};
  const int all = (int) (sizeof(header) + size);
  fwrite(&all, sizeof(int), 1, fp);
  fwrite(&header, sizeof(header), 1, fp);
  fwrite(state, 1, size, fp);
}

std::string_view LAMMPS_NS::read_state(LAMMPS *lmp, const std::string &id, const char *buf)
{
  StateHeader header;
  memcpy(&header, buf, sizeof(header));
  const char *const state = buf + sizeof(header);
  if (!(header.size >= 0.0) || header.minus_size != -header.size ||
      header.checksum != checksum(state, (std::size_t) header.size))
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "The state of fix {} in the restart file is not what was written: the file was "
                    "damaged, or is of another version of this package; take another file",
                    id);
  // a file that is written during a run has the time of an earlier step with the number of that
  // step, which LAMMPS sets to the present one when a run begins: the time between would be lost
  lmp->update->update_time();
  return {state, (std::size_t) header.size};
}

const char *LAMMPS_NS::read_state(LAMMPS *lmp, const std::string &id, const char *buf,
                                  std::size_t size)
{
  const auto state = read_state(lmp, id, buf);
  if (state.size() != size) refuse_state(lmp, id);
  return state.data();
}

void LAMMPS_NS::refuse_state(LAMMPS *lmp, const std::string &id)
{
  lmp->error->all(FLERR, Error::NOLASTLINE,
                  "The state of fix {} in the restart file is longer or shorter than that of this "
                  "fix: the file was written with other options of it, or by another version of "
                  "this package; give the fix the options of the file, or another ID to begin anew",
                  id);
}
