/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PIECES_H
#define LMP_MPM_PIECES_H

#include "field/mpm_halo.h"
#include "lattice/grid.h"
#include "math/sets.h"
#include "pointers.h"

#include <cmath>
#include <vector>

namespace LAMMPS_NS {
class FixMPMFracture;
class MPMField;

/** Connected pieces of a body of points. Two points are of one piece if one of them reaches the
 *  other one, no damaged point is closer to both than they are to each other, and neither is out of
 *  the body behind the surface of the other one. All that this needs it has itself: the fields are
 *  only read. */
class MPMPieces : protected Pointers {
 public:
  explicit MPMPieces(class LAMMPS *);

  /** Sets piece[i] of the points of the group, which is the smallest ID of a point in the piece.
   *  That of other atoms, and of points whose damage is at least separable, stays. The points of
   *  all these fields are one body. fracture: knows the surfaces of bodies, or null. Collective. */
  void find(const std::vector<MPMField *> &body, const FixMPMFracture *fracture, int groupbit,
            double separable, double *piece);
  double memory_usage() const;

 private:
  struct Point {
    double x[3];              // place on the lattice
    double reach;             // without deformation
    double near, far;         // in all directions at least, and in any direction at most
    const MPMField *field;    // null: the point is of another rank
    int source;               // index of the atom, or of the point in the list of others
    int cell;                 // slot*64 + n
    bool damaged;
  };
  struct Other {    // of another rank
    Point point;
    double F[3][3], normal[3];
    tagint tag;
    int place;    // index of its cell among those that are shared
  };
  struct Offset {
    int cells[3], level;    // largest number of cells along an axis
    bool is_face, is_positive;
  };

  const int dim;
  MPM_NS::Grid grid;    // of cells: node i is the cell from node i to the next one of the fields
  MPMHalo halo;
  const FixMPMFracture *fracture = nullptr;
  double period[3] = {INFINITY, INFINITY, INFINITY};    // of the box
  std::vector<Point> points;                            // those of this rank are first
  std::vector<std::vector<Other>> send, others;         // [sharer]
  std::vector<std::vector<int>> sent;                   // [sharer] points in the order of send
  std::vector<int> first_other;                         // [sharer] index in points
  std::vector<int64_t> canonical;                       // [cell], or empty: no axis is periodic
  std::vector<int> first, order;           // points by cell, first those without damage
  std::vector<int> filled;                 // cells with such points
  std::vector<Offset> offsets;             // to cells in reach
  std::vector<char> range;                 // [cell] distance of cells that its points reach
  std::vector<char> near_damage, whole;    // [cell] are all its points of one piece?
  int most_range = 1;
  double per_spacing = 1.0;
  std::vector<int> low, high;    // [block][3] range of cells with points
  struct {
    int index[3], cell;    // of the last point; without the period of the box
  } last = {};
  MPM_NS::Sets sets;
  std::vector<tagint> label;    // [set]
  int left = 0;                 // sets of points without damage

  void collect(const std::vector<MPMField *> &body, int groupbit, double separable);
  int find_cell(const double *x);
  void find_cells();
  void sort();
  void exchange();
  void mark_cells();
  void find_offsets();
  void join_inside(int cell);
  void join_cells(int a, int b);
  bool are_joined(const Point &, const Point &) const;
  bool extends_to(const Point &, const double *d) const;
  bool is_behind(const Point &, const double *d, double r) const;
  bool has_damage_between(const Point &, const Point &, const double *d, double r) const;
  double distance2(const Point &, const Point &, double *d) const;
  void deformation_of(const Point &, double F[3][3]) const;
  const Other &other(const Point &) const;
  void find_labels();
  template <class F> void each_cell_near(int cell, int distance, const F &f) const;
  template <class T>
  void swap(std::vector<std::vector<T>> &mine, std::vector<std::vector<T>> &theirs);
};

}    // namespace LAMMPS_NS
#endif
