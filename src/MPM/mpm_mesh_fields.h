/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_FIELDS_H
#define LMP_MPM_MESH_FIELDS_H

// What a mesh file says of its points besides their places: types, groups, and data.

#include "mpm_point_columns.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace MPM_NS {
struct Mesh;
}

namespace LAMMPS_NS {

/** The fields of points that create_points makes from the nodes or elements of a mesh. */
class MPMMeshFields : protected Pointers {
 public:
  /** Numbers of a file, what they are for points, and a factor on them. */
  struct Data {
    std::string name, quantity;
    double factor = 1.0;
  };

  /** at_nodes: points are nodes, else elements. type: of all points, or, by_type, the tag of their physical group, which is the place of their set
   *  in the file where sets have no tags. by_group: points join groups with the names of their sets, which are made
   *  if there are none. data: what points get of the file, as columns of a table do. Stops with an error for what the file or the
   *  simulation does not have, and for nodes that would have two types. */
  MPMMeshFields(LAMMPS *, const MPM_NS::Mesh &, bool at_nodes, int type, bool by_type,
                bool by_group, const std::vector<Data> &);

  /** The next point that this process makes is that of node or element k. */
  void add(int k) { mine.push_back(k); }

  /** Gives the points from this one on what they have. */
  void set(int first);

  /** Volume of node or element k over its initial one. */
  double jacobian(int k) const;

  /** What the points get; none of the columns is a place or a volume. */
  const MPMPointColumns &given() const { return columns; }

  /** For the log. */
  std::string types() const;

 private:
  bool at_nodes;
  std::vector<int> mine, type,
      bits;    // by node or element; no types: all have that of the command
  MPMPointColumns columns;
  std::vector<double> rows;    // of all nodes or elements
  int only_type;

  void find_types(const MPM_NS::Mesh &);
  void find_groups(const MPM_NS::Mesh &);
  void find_data(const MPM_NS::Mesh &, const Data &, std::vector<std::vector<double>> &);
};

}    // namespace LAMMPS_NS
#endif
