/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_ROWS_H
#define LMP_MPM_ROWS_H

#include "memory.h"

namespace LAMMPS_NS {

/** Rows of reals for all atoms, one after the other in memory that another object owns. Unlike
 *  arrays of LAMMPS, they need no pointer to each row, which saves 8 bytes per atom. */
class MPMRows {
 public:
  MPMRows() = default;
  MPMRows(double *first, int width) : first(first), width(width) {}
  double *operator[](int i) const { return first + (bigint) width * i; }
  explicit operator bool() const { return first; }

  /** These rows with room for n rows of the given width; n = 0 frees the memory. */
  MPMRows grown(Memory *memory, int n, int row_width, const char *name) const
  {
    const bigint bytes = (bigint) sizeof(double) * row_width * n;
    if (n == 0) memory->sfree(first);
    return {n ? (double *) memory->srealloc(first, bytes, name) : nullptr, row_width};
  }

 private:
  double *first = nullptr;
  int width = 0;
};

}    // namespace LAMMPS_NS
#endif
