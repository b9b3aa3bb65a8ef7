/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_FIELDS_H
#define LMP_MPM_MESH_FIELDS_H

// What a mesh file says of its points besides their places: types, groups, velocities, properties.

#include "pointers.h"

#include <array>
#include <string>
#include <vector>

namespace MPM_NS {
struct Mesh;
}

namespace LAMMPS_NS {

/** The fields of points that create_points makes from the nodes or elements of a mesh. */
class MPMMeshFields : protected Pointers {
 public:
  using Names = std::vector<std::array<std::string, 2>>;

  /** at_nodes: points are nodes, else elements. type: of all points, or, by_type, the tag of their physical group, which is the place of their set
   *  in the file where sets have no tags. by_group: points join groups with the names of their sets, which are made
   *  if there are none. data: names in the file, and quantities of points. Stops with an error for what the file or the
   *  simulation does not have, and for nodes that would have two types. */
  MPMMeshFields(LAMMPS *, const MPM_NS::Mesh &, bool at_nodes, int type, bool by_type,
                bool by_group, const Names &data);

  /** The next point that this process makes is that of node or element k. */
  void add(int k) { mine.push_back(k); }

  /** Gives the points from this one on what they have. */
  void set(int first);

  /** For the log. */
  std::string types() const;

 private:
  struct Field {
    std::string quantity;
    int index;    // of a property; -1: velocity
    bool is_integer;
    int columns;    // 0: a vector
    int width;
    std::vector<double> values;
  };
  bool at_nodes;
  std::vector<int> mine, type,
      bits;    // by node or element; no types: all have that of the command
  std::vector<Field> fields;
  int only_type;

  void find_types(const MPM_NS::Mesh &);
  void find_groups(const MPM_NS::Mesh &);
  void find_data(const MPM_NS::Mesh &, const std::string &name, const std::string &quantity);
};

}    // namespace LAMMPS_NS
#endif
