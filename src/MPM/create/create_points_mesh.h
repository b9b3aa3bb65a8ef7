/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_CREATE_POINTS_MESH_H
#define LMP_CREATE_POINTS_MESH_H

// create_points TYPE mesh FILE and create_points TYPE elements FILE: keywords, and the points.

#include "create/mpm_mesh_fields.h"
#include "declare/option.h"
#include "elements/mpm_elements_options.h"
#include "pointers.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
struct Mesh;
}

namespace LAMMPS_NS {

/** A point that create_points makes. */
struct CreatePointsSite {
  static constexpr imageint NO_IMAGE =
      ((imageint) IMGMAX << IMG2BITS) | ((imageint) IMGMAX << IMGBITS) | IMGMAX;

  double x[3];
  double volume;
  tagint tag;
  int type = 0;                 ///< 0: the type of the command
  double gray = 0.0;            ///< value of the image
  imageint image = NO_IMAGE;    ///< of nodes of a mesh, wrapped into the periodic box
};

/** Keywords of create_points for meshes. */
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
