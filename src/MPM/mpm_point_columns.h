/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_COLUMNS_H
#define LMP_MPM_POINT_COLUMNS_H

// Numbers by name, in the words of dump mpm/vtk, become the state of points.

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
struct MPMPoints;

/** Columns of numbers that new points get: velocity, F, stress, mass, radius, image, history variables of materials, and
 *  vectors and arrays of fix property/atom. The names of components are those of compute mpm/atom, as stress/xy, or
 *  NAME:k, as VTK numbers them. Places, volumes, types, and IDs are needed before there is a point: these columns are found by
 *  find(), and not set. */
class MPMPointColumns : protected Pointers {
 public:
  explicit MPMPointColumns(LAMMPS *lmp) : Pointers(lmp) {}

  enum Kind {
    PLACE,
    ID,
    TYPE,
    VOLUME0,
    VOLUME,
    DENSITY,
    MASS,
    VELOCITY,
    DEFORMATION,
    STRESS,
    RADIUS,
    IMAGE,
    HISTORY,
    PROPERTY,
    FOLLOWS,    ///< from other columns, or is of no point: not taken
    UNKNOWN
  };

  /** The next column of the rows. */
  Kind add(const std::string &name);

  /** The name of component c of what has so many numbers for each point, as arrays of VTK have: NAME:c, and NAME for one
   *  number; six of the stress are xx yy zz xy xz yz. */
  static std::string component_name(const std::string &name, int c, int width);

  /** The column of a component, -1: there is none. */
  int find(Kind, int component = 0) const;

  /** What makes this number no value of this column; empty: nothing. */
  std::string wrong(int column, double value) const;

  /** The columns of this kind are not taken, as they follow from others. */
  void leave(Kind);

  /** Do they have what deformation leaves behind: F, stress, or history? */
  bool has_state() const;

  /** Gives the points from this one on what their rows have. Their group and what fixes keep of them are set already. */
  void set(int first, const std::vector<double> &rows) const;

  /** State that points have and these columns do not: after set(), for a warning; empty: they have all. */
  std::string missing() const;

  /** An earlier column that is the same quantity, -1: none. */
  int same(int column) const;

  /** How many there are, and their names, which add() understands, with NULL for those left out. */
  int size() const { return (int) columns.size(); }
  std::string names() const;

  /** Names of the columns that are taken, or of those that are not, for the log. */
  std::string names(bool taken) const;

 private:
  struct Column {
    std::string name;
    Kind kind;
    int component = 0;    // of a quantity, or column of a property
    int index = -1;       // of a property
    bool is_integer = false, is_array = false;
  };
  std::vector<Column> columns;

  void set_one(MPMPoints &, const std::vector<FixMPMMaterial *> &, int i, const double *row) const;
  Column column_of(const std::string &name) const;
  bool find_property(const std::string &name, Column &) const;
};

}    // namespace LAMMPS_NS
#endif
