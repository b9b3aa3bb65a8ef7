/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_ELEMENT_FORCES_H
#define LMP_ELEMENT_FORCES_H

#include "elements/element_nodes.h"
#include "elements/mpm_elements_options.h"
#include "material/plane_stress.h"
#include "mesh/element_body.h"
#include "pointers.h"

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** A batch of integration points, and their elements. */
struct ElementBatch {
  struct Element {
    std::size_t number;
    double *row;
    const MPM_NS::ElementRule &rule;
    int start;    ///< first point of the element in the batch
  };
  std::vector<Element> elements;
  int n;                                                    ///< number of points in the batch
  double *state[MPM_NS::BATCH];                             ///< F, tau, history
  double g[MPM_NS::BATCH][MPM_NS::MAX_ELEMENT_NODES][3];    ///< gradients of functions in space
  double volume[MPM_NS::BATCH];                             ///< reference volume
  double J[MPM_NS::BATCH];                                  ///< determinant of F without F-bar
  MPM_NS::Batch batch = {};             ///< must start from zero, see material/batch_kernels.h
  std::vector<double> history, mean;    ///< history of the batch; means over an element
  std::vector<MPM_NS::PlaneStress::Point> thin;    ///< [BATCH], for surfaces and lines
};

/** Strain, stress, and forces of the elements of a body: total Lagrangian, with the law of the
 *  material of the nodes. Surfaces and lines are in plane stress. */
class ElementForces : protected Pointers, private MPMElementsOptions {
 public:
  /** id: of the fix, for messages. */
  ElementForces(LAMMPS *, const std::string &id, const MPMElementsOptions &, MPM_NS::ElementBody &);

  /** Length of the smallest element, for artificial viscosity, and volume of the elements. */
  double shortest = std::numeric_limits<double>::max(), volume = 0.0;
  /** Bound of the largest frequency of free nodes by bending. */
  double bending_frequency = 0.0;

  /** Sets the material of the nodes, and the stiffness of bending; stops with an error if it cannot
   *  be that of a surface or line. */
  void define(class FixMPMMaterial *);
  /** Fills the row of an element that is not deformed. x: positions of all nodes of the mesh; low:
   *  ID of the first one; rough: counts triangles that know too few nodes around them. */
  void make_row(double *row, const MPM_NS::MeshElement &, const double *x, tagint low,
                bigint &rough);
  /** The stress without motion, of an equation of state. */
  void set_initial_stress();

  /** Strains all elements to the present positions of their nodes, and adds forces [0, 3), and F,
   *  tau, and history times the volume [3, 18 + nhistory) to the sums [local and ghost][width] of
   *  nodes. starting: at the start of a run, where nothing has moved. */
  void strain(bool starting, double *sums, int width);

  /** A trial motion: displacements [local and ghost][3], and a shift of one node of each element;
   *  -1: none. good: is all finite? */
  struct Trial {
    const double *motion;
    int shifted_node = -1;
    double shift[3] = {0.0, 0.0, 0.0};
    bool good = true;
  };
  using Use = std::function<void(std::size_t e, int nnode, const double (*on)[3])>;
  /** Calls use(element, its number of nodes, forces on them [force]) with the state after the
   *  motion, and restores the state. Returns false if it is not finite. */
  bool try_motion(Trial &, const Use &);

  /** Adds the energy stored by the elements of this rank [pressure * volume]. */
  void add_stored_energy(double &sum);
  /** Finds bending_frequency, of nodes in this group. Collective. */
  void find_bending_frequency(int groupbit, const ElementNodes::IDs &);
  /** Smallest 2/omega with a bound of the highest frequency omega of the elements of this rank.
   *  tag: a node of the limiting element, 0: there is none; speed: its wave speed. */
  double stable_dt(tagint &tag, double &speed);
  double memory_usage() const { return (double) batch.history.capacity() * sizeof(double); }

 private:
  const std::string id;
  const int dim;
  MPM_NS::ElementBody &body;
  FixMPMMaterial *material = nullptr;
  std::unique_ptr<MPM_NS::PlaneStress> plane_stress;    // of surfaces and lines
  ElementBatch batch;
  Trial *trial = nullptr;    // null: the nodes are where they are

  void define_points(double *row, const double (*X)[3], const double *first);
  double gradients(const MPM_NS::ElementRule &, int q, const double (*x)[3], double (*g)[3]) const;
  void check_frame(const double (*frame)[3], bigint label) const;
  void find_frame(const double (*g)[3], double (*frame)[3]) const;
  void find_motion(const double (*x)[3], const double (*g)[3], int nnode, double *to) const;
  void for_batches(bool moved, const std::function<void(ElementBatch &)> &visit);
  void load(ElementBatch &, std::size_t e, bool moved) const;
  void load_thin(MPM_NS::PlaneStress::Point &, const double (*x)[3], const double (*g)[3],
                 int nnode, const double *state) const;
  void find_stretches(ElementBatch &);
  void find_stress(ElementBatch &, bool starting);
  void map_gradients(ElementBatch &);
  void find_forces(const ElementBatch &, int start, const MPM_NS::ElementRule &,
                   double (*f)[3]) const;
  void add_sums(ElementBatch &, double *sums, int width) const;
};

/** Derivatives of the forces on the nodes of each element by the displacements of its nodes, of the
 *  elements and of the pressure on their surface: central differences, one component of one node at
 *  a time, in all elements at once. Vectors are [local and ghost][3]. */
class ElementTangents {
 public:
  ElementTangents(const MPM_NS::ElementBody &body, ElementForces &forces,
                  const class ElementSurface &surface) :
      body(body),
      forces(forces), surface(surface)
  {
  }

  /** Finds them after a motion. Returns the sum of the largest one of each element, times the
   *  length of the shortest element. */
  double find(const double *motion);
  /** Adds the change of the forces by a motion. */
  void add_change(const double *motion, double *to) const;
  /** Adds the stiffness of each node along the axes against its own motion along axis b. */
  void add_stiffness(int b, double *to) const;
  /** Largest difference of opposite derivatives, relative to the largest derivative. */
  double asymmetry() const;

 private:
  const MPM_NS::ElementBody &body;
  ElementForces &forces;
  const ElementSurface &surface;
  int size = 0;
  std::vector<double> tangents;    // [element][size][size], size = maxnode dim
};

}    // namespace LAMMPS_NS
#endif
