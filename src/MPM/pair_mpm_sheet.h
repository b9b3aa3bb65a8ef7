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

#include "declare/option.h"
#include "mesh/near_nodes.h"
#include "mesh/passages.h"
#include "pair.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/** Settings of pair_style mpm/sheet. */
struct MPMSheetOptions {
  double distance = 0.0;    ///< of two sheets that touch

  MPM_NS::Options declare();
};

/** Settings of pair_coeff for mpm/sheet, as they are in restart files. */
struct MPMSheetCoeff {
  double stiffness = 0.0;    ///< force/distance
  double damping = 0.0;      ///< force/velocity
  int64_t set = 0;           ///< given by pair_coeff

  MPM_NS::Options declare();
};

/** Contact of surfaces and lines (fix mpm/elements with thickness or section) that no lattice moves with themselves, with
 *  each other, and with any other atoms: two of them that are closer than a distance D repel each other with
 *  k (D - r), except for nodes of one body that are near each other along it (by a path shorter than 2 D without
 *  deformation). D must be large enough for the mesh that nodes cannot pass between those of another layer. */
class PairMPMSheet : public Pair, private MPMSheetOptions {
 public:
  PairMPMSheet(class LAMMPS *);
  ~PairMPMSheet() override;
  void compute(int, int) override;
  void settings(int, char **) override;
  void coeff(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;
  void write_restart(FILE *) override;
  void read_restart(FILE *) override;
  void write_restart_settings(FILE *) override;
  void read_restart_settings(FILE *) override;
  double memory_usage() override;

 private:
  using Coeff = MPMSheetCoeff;

  struct Body {
    class FixMPMElements *elements;
    tagint low;    // ID of its first node
    std::unique_ptr<MPM_NS::NearNodes> nodes;
  };

  std::vector<Coeff> coeffs;    // [ntypes+1][ntypes+1]
  std::vector<Body> bodies;
  std::vector<std::pair<int, int>> pairs;    // that can touch, of the present neighbor list
  bool starting = true;    // before the first step of bodies that are not from a restart file
  bool warned_deep = false, warned_dt = false, warned_gap = false, warned_through = false;
  MPM_NS::Passages passages;

  void allocate();
  void find_bodies();
  void find_pairs();
  void warn_about_step();
  void warn_about_start();
  void warn_about_gaps();
  void warn_about_passages();
  void share_passages(std::vector<MPM_NS::Passages::FaceID> &mine);
  std::vector<MPM_NS::Passages::Sight> look_at_faces(std::vector<MPM_NS::Passages::FaceID> &mine);
  int body_of(int i) const;
  Coeff &coeff_of(int i, int j);
};

}    // namespace LAMMPS_NS
#endif
#endif
