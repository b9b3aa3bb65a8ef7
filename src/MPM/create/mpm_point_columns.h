/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_COLUMNS_H
#define LMP_MPM_POINT_COLUMNS_H

// Sets the state of points from columns of numbers, which are named as in dump mpm/vtk.

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
struct MPMPoints;

/** A point that create_points makes. */
struct CreatePointsSite {
  static constexpr imageint NO_IMAGE =
      ((imageint) IMGMAX << IMG2BITS) | ((imageint) IMGMAX << IMGBITS) | IMGMAX;

  double x[3];
  double volume;
  tagint tag;                   ///< 0: not known yet
  int type = 0;                 ///< 0: the type of the command
  double gray = 0.0;            ///< value of the image
  imageint image = NO_IMAGE;    ///< of nodes of a mesh, wrapped into the periodic box

  /** Moves it into the box; false if it is neither there nor in one of the next periodic images.
   *  What is farther away is a mistake, and LAMMPS would move it image by image. */
  bool wrap(class Domain *);
};

/** Columns of numbers that set the state of new points: velocity, F, stress, mass, radius, image,
 *  history variables of materials, and vectors and arrays of fix property/atom. Components are
 *  named as in compute mpm/atom, such as stress/xy, or NAME:k, as VTK numbers them. Positions,
 *  volumes, types, and IDs are needed before a point exists: find() finds these columns, and set()
 *  does not use them. */
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
    FOLLOWS,    ///< not taken: it follows from other columns, or is no property of points
    UNKNOWN
  };

  /** Adds the next column of the rows, and returns its kind. */
  Kind add(const std::string &name);

  /** Name of component c of a quantity with width numbers per point, as arrays of VTK have: NAME:c,
   *  or NAME if there is only one number. The six components of the stress are xx yy zz xy xz
   *  yz. */
  static std::string component_name(const std::string &name, int c, int width);

  /** The column of a component, or -1 if there is none. */
  int find(Kind, int component = 0) const;

  /** Why this number is not valid in this column; empty if it is valid. */
  std::string wrong(int column, double value) const;

  /** Leave out all columns of this kind, because they follow from others. */
  void leave(Kind);

  /** Is there any column of F, stress, or history, the state that deformation leaves behind? */
  bool has_state() const;

  /** Sets the state of the points from first on to the values in rows. The group of these points
   *  and the data that fixes keep of them must be set already. */
  void set(int first, const std::vector<double> &rows) const;

  /** State that points have and that these columns do not set, for a warning; empty if nothing is
   *  missing. Call after set(). */
  std::string missing() const;

  /** An earlier column of the same quantity, or -1 if there is none. */
  int same(int column) const;

  /** Number of columns, and their names in a form that add() understands, with NULL for those left
   *  out. */
  int size() const { return (int) columns.size(); }
  std::string names() const;

  /** Names of the columns that are taken, or of those that are not taken, for the log. */
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
