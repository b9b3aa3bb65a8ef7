/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_CREATE_POINTS_MESH_H
#define LMP_CREATE_POINTS_MESH_H

// create_points TYPE mesh FILE and create_points TYPE elements FILE: keywords, and the points.

#include "create/mpm_point_columns.h"
#include "declare/option.h"
#include "elements/mpm_elements_options.h"
#include "pointers.h"

#include <array>
#include <memory>

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

  void set(int first);

  /** Volume of node or element k relative to its initial volume. */
  double jacobian(int k) const;

  /** Columns that the points get; none of them is a position or a volume. */
  const MPMPointColumns &given() const { return columns; }

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

struct CreatePointsMeshOptions {
  double scale = 1.0, move[3] = {0.0, 0.0, 0.0};
  std::string part;           ///< physical group of the mesh; empty: all of it
  bool by_type = false;       ///< the type is the number of the physical group
  bool by_group = false;      ///< points join the group with the name of the physical group
  MPMMeshFields::Data one;    ///< the entry that was read last
  std::vector<MPMMeshFields::Data> data;       ///< data of the file that points get
  std::vector<MPMMeshFields::Data> factors;    ///< factors on data, by name
  MPMThinBody thin;                            ///< surfaces or lines, for points at nodes
  int halve = 0;                               ///< number of times that elements are divided
  double diameter = 0.0;
  std::string group_id;

  MPM_NS::Options declare(const std::string &command, int dimension, bool has_radius, bool nodes);
};

/** The points at the nodes of a mesh, or for its elements: all ranks have all of them, in the order
 *  of the file. */
class CreatePointsMesh : protected Pointers {
 public:
  using Corners = std::array<double, 24>;    ///< relative to the center, see transfer/cpdi.h

  std::vector<CreatePointsSite> sites;
  std::vector<Corners> corners;    ///< domains of elements; finally of the points made here
  std::unique_ptr<MPMMeshFields> fields;    ///< data of the points
  double volume = 0.0;                      ///< mean of all points

  /** Reads and checks the file; stops with an error if it is not valid. in_elements: a point for
   *  each element. type: of all points, unless the options take it from the file. axisymmetric: the
   *  field around whose axis the points are; null: none. */
  CreatePointsMesh(LAMMPS *, const CreatePointsMeshOptions &, const MPM_NS::Options &,
                   bool in_elements, int type, const char *file,
                   const class MPMField *axisymmetric);
  ~CreatePointsMesh() override;

  /** Gives the corners of domains to the fields that have domains, for the points from first on,
   *  which fixes have rows for. */
  void set_domains(int first);

 private:
  const MPMField *axisymmetric;

  void find_nodes(const MPM_NS::Mesh &, const MPMThinBody &, const char *file);
  void find_elements(const MPM_NS::Mesh &, const char *file);
  void check_periodic(const MPM_NS::Mesh &, const char *file) const;
  void wrap(const char *file, const char *what);
};

}    // namespace LAMMPS_NS
#endif
