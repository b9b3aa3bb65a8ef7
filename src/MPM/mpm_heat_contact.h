/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_CONTACT_H
#define LMP_MPM_HEAT_CONTACT_H

#include "declare/option.h"
#include "mpm_diffusion_solver.h"
#include "mpm_heat_body.h"
#include "pointers.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMHeatThin;

/** Two bodies that exchange heat where they touch. */
struct MPMHeatPair {
  std::string field[2];                    ///< IDs of their fix mpm
  MPM_NS::NumberOrVariable conductance;    ///< heat per area, time, and difference of temperature
  double now = 0.0;                        ///< in this step
};

/** Heat between two fields on one lattice where they touch: q = h_c (T_a - T_b) per area. */
class MPMHeatContact : protected Pointers {
 public:
  /** The fields must have a fix mpm/contact, which gives all ranks the nodes of both where they may meet. */
  MPMHeatContact(class LAMMPS *, MPMHeatBody &a, MPMHeatBody &b, const MPMHeatPair &);

  void extend_topology(const MPMField &);
  void topology_changed() { listed = false; }
  /** Marks blocks in which the bodies may meet. */
  void mark_near();
  /** Where the bodies touch, when their surfaces are known. thin: null, or gets all places of this entry. Collective. */
  void find_contacts(MPMHeatThin *thin, int entry);
  /** What the capacities of nodes make of it. Returns the largest rate of exchange of this rank [1/time]. */
  double begin_step();
  void note_edges() const;
  /** The difference of temperatures decays with this rate at the most: that of the fastest change otherwise; at edges with that
   *  of conduction. */
  void limit(double cap);
  /** Gives heat to both bodies, whose rates have all other heat already; adds the power from a to b of this rank. */
  void exchange(double &power) const;
  /** Is it symmetric on this rank? */
  bool is_symmetric() const;
  /** What this rank adds to the matrix of conduction of a body, as if the other one had its temperature. */
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
    double area, share;    // of this axis, and of this rank
    double response;
    double rate;         // at which the difference of temperatures decays
    double normal[3];    // from the first body to the second one
  };

  const std::array<MPMHeatBody *, 2> body;
  const MPMHeatPair &pair;
  bool listed = false;
  double fastest = 0.0;    // limit of the rate
  std::vector<Common> common;
  std::vector<Place> places;
  MPMHeatShares shares;

  void list_common_blocks();
  bool make_place(int axis, const int *index, int64_t a, int64_t b, Place &, MPMHeatThin *,
                  int entry) const;
};

}    // namespace LAMMPS_NS
#endif
