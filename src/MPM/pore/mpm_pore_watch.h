/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_WATCH_H
#define LMP_MPM_PORE_WATCH_H

#include "pointers.h"
#include "pore/mpm_pore.h"

#include <string>

namespace LAMMPS_NS {
class MPMPoreFlow;
struct MPMPoreOptions;
struct MPMPorePoints;

/** Looks at the flow of pore water, and warns once of results that are not what they seem. */
class MPMPoreWatch : protected Pointers {
 public:
  /** id: of the fix, for messages. */
  MPMPoreWatch(class LAMMPS *, const MPMPoreOptions &, const MPMPorePoints &, const MPMPoreFlow &,
               const std::string &id);

  /** Start of a run. neglects_inertia: may the acceleration of the water matter, which is left
   *  out? */
  void start(bool neglects_inertia);
  /** Warns of pair styles between points, which do not know the share of the water in a contact. */
  void warn_of_contact() const;
  /** Warns of materials without water that are thinner than the reach of nodes, at the first step,
   *  once. */
  void look_for_leaks();
  /** Warns once of pores that are shut, where the equations hold neither for the soil nor for its
   *  water. */
  void look_for_shut_pores();
  /** Warns once of flow through a surface that is not a face of the box, in a lump that one stage
   *  cannot take. steps: since the last flow; limit: explicit limit of the duration. */
  void look_for_long_flow(double duration, double limit, double steps);
  /** Warns once of pressures that vary over some cells and that points have lost to nodes in long
   *  runs, where the flow itself is too slow for that. duration: of a flow. */
  void look_for_smoothing(double duration);
  /** Measures the neglected acceleration between every fourth flow, see MPMPore::inertia():
   *  relevant motion is slower than waves of the lattice. Collective. */
  void watch_inertia();
  /** End of a run: warns once if the acceleration matters that formulation u-p neglects. */
  void look_at_inertia();

 private:
  const MPMPoreOptions &options;
  const MPMPorePoints &points;
  const MPMPoreFlow &flow;
  const std::string id;
  double smoothed =
      0.0;    // lost share of pressures that vary over some cells, see MPMPore::Smoothing, in these runs
  // u-p, since the first run: energies that the resistance to the flow would have taken by the
  // neglected acceleration (left_out), has taken (flow), and would have taken without the weight of
  // the water (gradient); sum of the magnitudes of changes of the kinetic energy (exchanged)
  struct {
    double left_out = 0.0, flow = 0.0, gradient = 0.0, exchanged = 0.0;
    double most = 0.0;        // largest kinetic energy so far
    MPMPore::Inertia last;    // last values, of all ranks
    double time = 0.0;        // of the last values
    bigint points = -1;       // number of points of the last values; -1: unknown
    bigint flows = 0;         // number of flows in this run
  } watched;
  bool measures_inertia = false;    // is watch_inertia() used in this run?
  // was a warning printed about it?
  bool inertia_known = false, smooth_known = false, long_known = false, shut_known = false;
  bool leaks_known = false;    // was look_for_leaks() called?
};

}    // namespace LAMMPS_NS
#endif
