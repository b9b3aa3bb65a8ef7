/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef PAIR_CLASS
// clang-format off
PairStyle(mpm/sheet,PairMPMSheet);
// clang-format on
#else

#ifndef LMP_PAIR_MPM_SHEET_H
#define LMP_PAIR_MPM_SHEET_H

#include "base/mpm_pair.h"
#include "declare/option.h"
#include "mesh/face_contact.h"
#include "mesh/near_nodes.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** Settings of pair_style mpm/sheet. */
struct MPMSheetOptions {
  double distance = 0.0;    ///< D, of two sheets that touch
  bool faces = false;       ///< do nodes touch triangles (in 2d lines) instead of nodes?

  MPM_NS::Options declare();
};

/** Settings of pair_coeff for mpm/sheet, as in restart files. */
struct MPMSheetCoeff {
  double stiffness = 0.0;    ///< force/distance
  double damping = 0.0;      ///< force/velocity
  int64_t set = 0;           ///< given by pair_coeff

  MPM_NS::Options declare();
};

/** Contact of surfaces and lines (fix mpm/elements with thickness or section) that no lattice
 *  moves: with themselves, with each other, and with any other atoms. Two nodes or atoms that are
 *  closer than a distance D repel each other with k (D - r), except for nodes of one body that are
 *  near each other along it (by a path shorter than 2 D without deformation). D must be large
 *  enough for the mesh that nodes cannot pass between those of another layer.
 *
 *  With faces, nodes touch the triangles of a surface (in 2d its lines) instead of its nodes. A
 *  node has a side of each face that is close. It keeps this side when it passes through the face,
 *  and is pushed back. */
class PairMPMSheet : public MPMPair<MPMSheetCoeff>, private MPMSheetOptions {
 public:
  PairMPMSheet(class LAMMPS *lmp) : MPMPair(lmp, "mpm/sheet") {}
  void compute(int, int) override;
  void settings(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;
  void write_restart_settings(FILE *) override;
  void read_restart_settings(FILE *) override;
  double memory_usage() override;

 private:
  using Coeff = MPMSheetCoeff;
  static constexpr int NO_BODY = -1;

  struct Face {
    int64_t low, node[3], number;
  };
  struct Body {
    class FixMPMElements *elements;
    tagint low;    // ID of its first node
    std::unique_ptr<MPM_NS::NearNodes> nodes;
    std::vector<Face> faces;           // with the keyword faces, in the order of their lowest nodes
    std::vector<std::size_t> first;    // of the faces of a node
  };
  struct FaceContact {    // of an atom with a face, or an edge or a node that several faces share
    int atom, nnode, node[3];
    double weight[3];                    // of the nodes
    double n[3];                         // unit vector along which the atom is pushed
    double gap;                          // negative: the atom is on the other side
    double share, stiffness, damping;    // see ContactPart
  };
  struct SeenFace {
    int body, node[3];    // local indices
    bigint number;        // twice the element, plus which half
  };
  struct Approach {    // of an atom of this rank and a face that can touch it
    int atom, face;
    // side: from which the atom is pushed; within: is it on the other one?
    MPM_NS::Passages::Sight sight;
    bool operator<(const Approach &other) const { return sight < other.sight; }
  };

  std::vector<Body> bodies;
  bool starting = true;    // until the first step, for bodies that are not from a restart file
  bool warned_deep = false, warned_dt = false, warned_gap = false, warned_through = false,
       warned_lost = false;
  MPM_NS::Passages passages;
  std::vector<SeenFace> seen;          // all faces of which this rank has the nodes
  std::vector<Approach> approaches;    // sorted: those of an atom are next to each other

  void find_bodies();
  void find_pairs();
  void warn_about_step();
  void warn_about_start();
  void warn_about_gaps();
  void warn_about_passages();
  void share_passages(std::vector<MPM_NS::Passages::FaceID> &mine);
  bool tell_first(const MPM_NS::Passages::Sight *found, const char *what) const;
  bool touches(int i, const SeenFace &);
  void for_atoms_near(const std::vector<SeenFace> &, int natoms, double range,
                      const std::function<void(int, int, const double *const[3])> &) const;
  void find_faces_of(Body &) const;
  void find_faces();
  double see_faces();
  void for_face_contacts(const std::function<void(const FaceContact &)> &);
  void touch_faces(int eflag);
  std::vector<MPM_NS::Passages::Sight> look_at_faces(std::vector<MPM_NS::Passages::FaceID> &mine);
  int body_of(int i) const;
};

}    // namespace LAMMPS_NS
#endif
#endif
