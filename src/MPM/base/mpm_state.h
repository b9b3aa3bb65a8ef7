/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STATE_H
#define LMP_MPM_STATE_H

#include "base/mpm_rows.h"
#include "fix.h"

#include <deque>
#include <functional>
#include <string>
#include <string_view>

namespace LAMMPS_NS {

/** The per-point arrays of a fix. The owners of the arrays declare them here. This class grows
 *  them, moves them with their atoms, and writes them to restart files. */
class MPMPointState {
 public:
  using Fresh = std::function<void(int i, double *row)>;

  explicit MPMPointState(class Memory *memory) : memory(memory) {}
  MPMPointState(const MPMPointState &) = delete;
  MPMPointState &operator=(const MPMPointState &) = delete;
  ~MPMPointState();

  /** Keep rows of width reals for all atoms; rows[i] is valid from the next grow() on. fresh:
   *  function that fills the row of a new atom; without it the row is zero. The reference to rows
   *  must stay valid as long as this object exists. */
  void declare(MPMRows &rows, const char *name, int width, Fresh fresh = nullptr);
  /** The same with a pointer to each row, as LAMMPS needs for output (array_atom). */
  void declare(double **&table, const char *name, int width, Fresh fresh = nullptr);
  /** The same for one real per atom. */
  void declare(double *&values, const char *name, Fresh fresh = nullptr);

  /** Are there no arrays? */
  bool empty() const { return arrays.empty(); }
  /** Number of reals of a point in all arrays. */
  int size() const;
  /** Names and widths, for instance "C 9, X 3", to compare with those of a restart file. */
  std::string layout() const;

  /** Memory for nmax atoms; copies of rows; rows of new atoms; rows to and from a buffer. */
  void grow(int nmax);
  void copy(int from, int to);
  void fresh(int i);
  int pack(int i, double *buf) const;
  int unpack(int i, const double *buf);

 private:
  struct Array {
    // pointer into the owner, who may be gone when the arrays are destroyed; one of the three is
    // set
    MPMRows *rows;
    double ***table;
    double **values;
    MPMRows mine;
    double **pointers;    // to the rows, with a table
    const char *name;
    int width;
    Fresh fresh;
  };
  class Memory *memory;
  std::deque<Array> arrays;
};

/** A fix with per-point arrays. It passes the callbacks of LAMMPS to its MPMPointState. */
class FixMPMState : public Fix {
 public:
  FixMPMState(class LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg), state(memory) {}
  ~FixMPMState() override;
  /** A number that no other fix has or had. */
  int instance() const { return instance_me; }
  /** Names and widths of the arrays that go to restart files; empty if there are none. */
  std::string keeps() const { return restarts ? state.layout() : ""; }
  double memory_usage() override;
  void grow_arrays(int nmax) override { state.grow(nmax); }
  void copy_arrays(int i, int j, int) override { state.copy(i, j); }
  void set_arrays(int i) override { state.fresh(i); }
  int pack_exchange(int i, double *buf) override { return state.pack(i, buf); }
  int unpack_exchange(int i, double *buf) override { return state.unpack(i, buf); }
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int size_restart(int) override { return 1 + state.size(); }
  int maxsize_restart() override { return 1 + state.size(); }

 protected:
  MPMPointState state;

  /** Call at the end of the constructor, when all arrays are declared. restarts: the arrays go to
   *  restart files. */
  void keep_arrays(bool restarts = true);
  /** The values of this fix for atom i from a restart file, n of them. The values of nth other
   *  fixes come first, each preceded by their number. */
  const double *from_restart(int i, int nth, int &n) const;

 private:
  bool restarts = false, callbacks = false;
};

/** Sums n values over processes: process 0 gets the sums, the others get zero. Restart files
 *  contain these sums, and the run that writes such a file continues with them, so that both have
 *  the same digits. */
void keep_totals(MPI_Comm, double *values, int n);
/** Checksum of bytes, an integer that a real can hold (FNV-1a). It shows if a restart file has been
 *  damaged. */
double checksum(const void *bytes, std::size_t size);
/** Writes the state of a fix to a restart file, with its checksum. For process 0. */
void write_state(FILE *, const void *state, std::size_t size);
/** The state in what Fix::restart() gets, as write_state() has written it; stops with an error if
 *  it has changed. id: of the fix. */
std::string_view read_state(class LAMMPS *, const std::string &id, const char *buf);
/** The same for a state of a known size; stops with an error if it has another one. */
const char *read_state(class LAMMPS *, const std::string &id, const char *buf, std::size_t size);
/** Stops with the error that a state has another size than the fix expects. */
[[noreturn]] void refuse_state(class LAMMPS *, const std::string &id);
/** Writes these sums as a state, followed by values that are the same on all processes. */
void write_totals(FILE *, MPI_Comm, std::vector<double> &totals,
                  const std::vector<double> &same = {});

}    // namespace LAMMPS_NS
#endif
