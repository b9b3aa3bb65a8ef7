/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef ATOM_CLASS
// clang-format off
AtomStyle(mpm,AtomVecMPM);
// clang-format on
#else

#ifndef LMP_ATOM_VEC_MPM_H
#define LMP_ATOM_VEC_MPM_H

#include "atom_vec.h"

namespace LAMMPS_NS {
struct MPMPoints;

/** Atom style mpm: material points with mass, initial volume, deformation gradient, and stress.
 *
 *  Atoms with initial volume 0 (grains, MD atoms, ...) are not material points and keep the mass
 *  that their own style gives them. The data file has columns for the mass density and the initial
 *  volume; in a hybrid with a sphere style, both styles share the density column.
 */
class AtomVecMPM : public AtomVec {
 public:
  AtomVecMPM(class LAMMPS *);
  ~AtomVecMPM() override;
  void process_args(int, char **) override;
  void init() override;

  void grow_pointers() override;
  void create_atom_post(int) override;
  void data_atom_post(int) override;
  void pack_data_pre(int) override;
  void pack_data_post(int ilocal) override
  {
    if (!after_sphere) rmass[ilocal] = rmass_one;
  }
  int property_atom(const std::string &) override;
  void pack_property_atom(int, double *, int, int) override;

  void copy_bonus(int, int, int) override;
  int pack_exchange_bonus(int, double *) override;
  int unpack_exchange_bonus(int, double *) override;
  int size_restart_bonus() override;
  int size_restart() override;
  int pack_restart(int, double *) override;
  int unpack_restart(double *) override;
  int pack_restart_bonus(int i, double *buf) override { return pack_exchange_bonus(i, buf); }
  int unpack_restart_bonus(int i, double *buf) override { return unpack_exchange_bonus(i, buf); }
  double memory_usage_bonus() override;

 private:
  MPMPoints *points;    // not owned: several styles and Atoms may refer to the same arrays
  double *rmass = nullptr, *vfrac = nullptr, *radius = nullptr;
  bool after_sphere = false;    // a sphere style converts density to mass before this style does
  double rmass_one;
};

}    // namespace LAMMPS_NS
#endif
#endif
