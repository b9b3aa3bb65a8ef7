/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/handshake,FixMPMHandshake);
// clang-format on
#else

#ifndef LMP_FIX_MPM_HANDSHAKE_H
#define LMP_FIX_MPM_HANDSHAKE_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_coupling.h"
#include "field/mpm_node_action.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Keywords of fix mpm/handshake. */
struct MPMHandshakeOptions {
  /** A zone in which the weight of the atoms falls linearly from 1 to 0 between two planes. */
  struct Zone {
    enum { X, Y, Z } axis;
    double one, zero;    ///< positions of the planes with weight 1 and 0
  };
  std::string field_name;
  std::vector<Zone> zones;
  double damping = 0.0;    ///< rate at which the fine motion is damped where w = 0 [1/time]

  MPM_NS::Options declare();

 private:
  Zone next = {Zone::X, 0.0, 0.0};    // the zone that is being read
};

/** Zones where atoms and material points describe the same material. Each has a share of its energy
 *  and mass, and both move with one velocity at the nodes of a field. */
class FixMPMHandshake :
    public FixMPMState,
    public MPMNodeAction,
    public MPMCoupling,
    private MPMHandshakeOptions {
 public:
  FixMPMHandshake(class LAMMPS *, int, char **);
  ~FixMPMHandshake() override;
  int setmask() override    // fix mpm calls the rest
  {
    return FixConst::PRE_NEIGHBOR | FixConst::POST_NEIGHBOR | FixConst::POST_FORCE;
  }
  void init() override;
  void init_list(int, class NeighList *ptr) override { list = ptr; }
  /** Its atoms, which have its ID here, and its field. */
  bool couples(const std::string &one, const std::string &other) const override
  {
    return (one == field_name && other == id) || (one == id && other == field_name);
  }
  int atoms_coupled_to(const std::string &one) const override
  {
    return one == field_name ? groupbit : 0;
  }
  void setup_pre_neighbor() override;
  void setup_post_neighbor() override { post_neighbor(); }
  void post_neighbor() override;
  void setup(int) override;
  void post_force(int) override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void grow_arrays(int) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void extend_topology(MPMField &) override;
  void act(double dt, Stage) override;

 private:
  enum Role { UNKNOWN, APART, COUPLED, POINT, NEAR_POINT };    // NEAR_POINT: near nodes of the zone

  /** Pair style eam, if it is used. */
  struct Embedded {
    class Pair *pair = nullptr;
    double flaw = 0.0;    // 1: its single() adds a term of the embedding energy to the force
    double share(int i, int type) const;
  };
  /** The nodes that each member reaches, and sums at all nodes. */
  struct Reach {
    int n = 0;                     // number of nodes of each member
    std::vector<int> nodes;        // [members][n]
    std::vector<double> shares;    // [members][n] weights of the nodes
    std::vector<double> sums;
    template <class Function> void each_node(std::size_t k, const Function &);
  };

  MPMField *field = nullptr;
  class NeighList *list = nullptr;
  double *weight;    // [n] share of the mass and energy of an atom or point in the zone
  double *role;      // [n] a Role
  Embedded eam;

  // of the present step

  std::vector<int> members;      // local atoms that are coupled, then points near the zone
  std::size_t natoms = 0;        // number of atoms in members
  std::vector<double> pushes;    // [natoms][3] forces g on atoms by the gradient of the weight
  Reach reach;
  struct {
    double heat, lost;    // energy lost so far by damping, and in total, this rank's share
  } energy = {0.0, 0.0};
  double force_on_points[3] = {};

  void refuse(bool broken, const std::string &why) const;
  void check_pair();
  void check_embedding();
  void weigh();
  void check_weights();
  void find_nodes();
  void find_pushes();
  void map_members(double dt);
  double work_of_pushes(double dt, double ahead) const;
  double kinetic_energy() const;
  void damp(double dt);
  std::vector<double> smooth_points();
  void tie(double dt);
  void move_atoms(double dt);
};

}    // namespace LAMMPS_NS
#endif
#endif
