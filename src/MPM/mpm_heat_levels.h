/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_LEVELS_H
#define LMP_MPM_HEAT_LEVELS_H

#include "mpm_conduction.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatBody;
class MPMTwoScale;

/** Temperatures of a body whose points are on several lattices (fix mpm/refine). They are functions of the free nodes of all
 *  lattices, as velocities are (MPMTwoScale): a tied node has the temperature of its parents, and its capacity and heat are theirs. */
class MPMHeatLevels : protected Pointers {
 public:
  /** Two lattices, from the coarsest pair on. */
  struct Pair {
    MPMTwoScale *nodes;
    MPMConduction *coarse, *fine;
    MPMHeatBody *coarse_surface, *fine_surface;    ///< null: surfaces are not wanted
  };

  MPMHeatLevels(class LAMMPS *, const std::vector<Pair> &);

  bool has(const MPMConduction &) const;
  /** Temperatures of the nodes of all lattices. Collective. Returns the bound of the rates of this rank, as
   *  MPMConduction::points_to_nodes() does for one. */
  double points_to_nodes(const MPMRows &gradients, bool starts);
  /** Rates of the nodes of all lattices from what points gave, but for tied nodes. Collective. */
  void sum_rates();
  /** Of tied nodes. */
  void temperatures_from_parents();
  void rates_from_parents();
  /** MPMHeatBody::share and gradient for the faces of the box. Collective. */
  void find_surface();
  /** A lattice that ends within reach of a face with a condition: a node there is tied, and another one of the same line is not.
   *  Tells once. Collective. */
  void look_for_thin_skins();

 private:
  std::vector<Pair> pairs;
  std::vector<MPMConduction *> levels;    // from the coarsest to the finest
  bool told = false;

  const MPMTwoScale *after(std::size_t k) const;
  template <class F> void to_parents(const F &);
  double bound_by_rows();
};

}    // namespace LAMMPS_NS
#endif
