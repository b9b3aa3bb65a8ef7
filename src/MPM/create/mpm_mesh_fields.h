/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_FIELDS_H
#define LMP_MPM_MESH_FIELDS_H

// What a mesh file says of its points besides their places: types, groups, and data.

#include "create/mpm_point_columns.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace MPM_NS {
struct Mesh;
}

namespace LAMMPS_NS {

/** Properties of the points that create_points makes from the nodes or elements of a mesh. */
class MPMMeshFields : protected Pointers {
 public:
  /** Name of data in a file, the quantity of points that they set, and a factor. */
  struct Data {
    std::string name, quantity;
    double factor = 1.0;
  };

  /** at_nodes: points are nodes, else elements. type: type of all points; with by_type, the type is
   *  instead the tag of the physical group, or the index of the set in the file if sets have no
   *  tags. by_group: points join groups with the names of their sets; missing groups are created.
   *  data: what points get from the file, as from the columns of a table. Stops with an error if
   *  the file or the simulation lacks something, or if nodes would have two types. */
  MPMMeshFields(LAMMPS *, const MPM_NS::Mesh &, bool at_nodes, int type, bool by_type,
                bool by_group, const std::vector<Data> &);

  /** Tells that the next point that this process makes is that of node or element k. */
  void add(int k) { mine.push_back(k); }

  /** Sets the properties of the points from this index on. */
  void set(int first);

  /** Volume of node or element k relative to its initial volume. */
  double jacobian(int k) const;

  /** Columns that the points get; none of them is a position or a volume. */
  const MPMPointColumns &given() const { return columns; }

  /** Description of the types for the log. */
  std::string types() const;

 private:
  bool at_nodes;
  std::vector<int> mine, type,
      bits;    // by node or element; type is empty if all have the type of the command
  MPMPointColumns columns;
  std::vector<double> rows;    // values of all nodes or elements
  int only_type;

  void find_types(const MPM_NS::Mesh &);
  void find_groups(const MPM_NS::Mesh &);
  void find_data(const MPM_NS::Mesh &, const Data &, std::vector<std::vector<double>> &);
};

}    // namespace LAMMPS_NS
#endif
