/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_CONTACT_H
#define LMP_MPM_HEAT_CONTACT_H

#include "declare/option.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "heat/mpm_heat_body.h"
#include "pointers.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatThin;

/** Two bodies that exchange heat where they touch. */
struct MPMHeatPair {
  std::string field[2];                    ///< IDs of the fix mpm of both bodies
  MPM_NS::NumberOrVariable conductance;    ///< heat per area, time, and difference of temperature
  double now = 0.0;                        ///< conductance in this step
};

/** Heat exchange between two fields on one lattice where they touch: q = h_c (T_a - T_b) per
 *  area. */
class MPMHeatContact : protected Pointers {
 public:
  /** The fields must have a fix mpm/contact, which gives all ranks the nodes of both fields where
   *  they may meet. */
  MPMHeatContact(class LAMMPS *, MPMHeatBody &a, MPMHeatBody &b, const MPMHeatPair &);

  /** Activates the blocks around those of a field, if it is one of the two. */
  void extend_topology(const MPMField &);
  /** The blocks of a field are new. */
  void topology_changed() { listed = false; }
  /** Marks blocks in which the bodies may meet. */
  void mark_near();
  /** Finds the places where the bodies touch, once their surfaces are known. thin: null, or
   *  receives all places of this entry. Collective. */
  void find_contacts(MPMHeatThin *thin, int entry);
  /** Updates the exchange for the capacities of nodes. Returns the largest rate of exchange on this
   *  rank [1/time]. */
  double begin_step();
  /** Notes the lines of this contact for edges of both bodies. */
  void note_edges() const;
  /** Limits the rate at which the difference of temperatures decays: to cap, the rate of the
   *  fastest other change. At edges, the limit is the rate of conduction. */
  void limit(double cap);
  /** Gives heat to both bodies, whose rates must include all other heat already. Adds the power
   *  from a to b on this rank. */
  void exchange(double &power) const;
  /** Is the exchange symmetric on this rank? */
  bool is_symmetric() const;
  /** Passes on the terms that this rank adds to the matrix of conduction of a body, as if the other
   *  body had the same temperature. */
  void each_term(const MPMHeatBody &, const MPMDiffusion::Term &) const;

  double memory_usage() const;

 private:
  struct Common {    // a block of nodes that both fields have
    int slot[2];
    uint64_t canonical;
  };
  struct Place {
    int64_t key;
    MPMHeatBody::Line line[2];
    double area, share;    // area and share that belong to this axis and this rank
    double response;
    double rate;         // rate at which the difference of temperatures decays
    double normal[3];    // unit normal from the first body to the second one
  };

  const std::array<MPMHeatBody *, 2> body;
  const MPMHeatPair &pair;
  bool listed = false;
  double fastest = 0.0;    // upper limit of the rate
  std::vector<Common> common;
  std::vector<Place> places;
  MPMHeatShares shares;

  void list_common_blocks();
  bool make_place(int axis, const int *index, int64_t a, int64_t b, Place &, MPMHeatThin *,
                  int entry) const;
};

}    // namespace LAMMPS_NS
#endif
