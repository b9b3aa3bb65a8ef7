/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_LEVELS_H
#define LMP_MPM_HEAT_LEVELS_H

#include "heat/mpm_conduction.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatBody;
class MPMTwoScale;

/** Temperatures of a body whose points are on several lattices (fix mpm/refine). Temperatures are
 *  functions of the free nodes of all lattices, as velocities are (MPMTwoScale): a tied node has
 *  the temperature of its parents, and passes its capacity and heat on to them. */
class MPMHeatLevels : protected Pointers {
 public:
  /** Two adjacent lattices; the list of pairs starts with the coarsest one. */
  struct Pair {
    MPMTwoScale *nodes;
    MPMConduction *coarse, *fine;
    MPMHeatBody *coarse_surface, *fine_surface;    ///< null: surfaces are not needed
  };

  MPMHeatLevels(class LAMMPS *, const std::vector<Pair> &);

  /** Is this one of the lattices? */
  bool has(const MPMConduction &) const;
  /** Finds the temperatures of the nodes of all lattices. Collective. Returns the bound of the
   *  rates on this rank, as MPMConduction::points_to_nodes() does for one lattice. */
  double points_to_nodes(const MPMRows &gradients, bool starts);
  /** Finds the rates of the nodes of all lattices, except tied nodes, from the contributions of
   *  points. Collective. */
  void sum_rates();
  /** Set the temperatures and rates of tied nodes. */
  void temperatures_from_parents();
  void rates_from_parents();
  /** Finds MPMHeatBody::share and gradient for the faces of the box. Collective. */
  void find_surface();
  /** Warns once if a lattice ends within reach of a face with a condition, so that a node there is
   *  tied and another node of the same line is not. Collective. */
  void look_for_thin_surfaces();

 private:
  std::vector<Pair> pairs;
  std::vector<MPMConduction *> levels;    // from the coarsest to the finest
  bool warned = false;

  const MPMTwoScale *after(std::size_t k) const;
  template <class F> void to_parents(const F &);
  double bound_by_rows();
};

}    // namespace LAMMPS_NS
#endif
