/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "base/atom_vec_mpm.h"

#include "atom.h"
#include "atom_vec_hybrid.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "error.h"
#include "math_const.h"
#include "modify.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>

using namespace LAMMPS_NS;

// names for compute property/atom, in the order of their indices; stress is symmetric

enum { VOLUME0, VOLUME, JACOBIAN, DENSITY, F11, STRESS11 = F11 + 9, STRESS21 = STRESS11 + 6 };

static constexpr const char *properties[] = {
    "mpm_volume0",  "mpm_volume",   "mpm_J",        "mpm_density",  "mpm_F11",      "mpm_F12",
    "mpm_F13",      "mpm_F21",      "mpm_F22",      "mpm_F23",      "mpm_F31",      "mpm_F32",
    "mpm_F33",      "mpm_stress11", "mpm_stress22", "mpm_stress33", "mpm_stress12", "mpm_stress13",
    "mpm_stress23", "mpm_stress21", "mpm_stress31", "mpm_stress32"};

MPMPoints *MPMPoints::get(Atom *atom, bool create)
{
  for (auto &field : atom->peratom)
    if (field.name == "mpm_points") return reinterpret_cast<MPMPoints *>(field.address);
  if (!create) return nullptr;

  static std::list<MPMPoints> pool;    // addresses stay valid, and stay reachable for leak checkers
  pool.emplace_back();
  auto *points = &pool.back();
  atom->add_peratom("mpm_points", points, Atom::DOUBLE, 0);    // in no list of fields
  return points;
}

void MPMPoints::grow(Memory *memory, int nmax)
{
  F = F.grown(memory, nmax, 9, "atom:mpm_F");
  tau = tau.grown(memory, nmax, 6, "atom:mpm_tau");
}

AtomVecMPM::AtomVecMPM(LAMMPS *lmp) : AtomVec(lmp)
{
  molecular = Atom::ATOMIC;
  mass_type = PER_ATOM;
  atom->rmass_flag = atom->vfrac_flag = 1;
  points = MPMPoints::get(atom, true);

  // F and stress go with the bonus data of LAMMPS, which a style keeps by itself
  // border: ghost points need nothing of this style (a sphere style sends radius and mass)
  // data_vel: must not have more columns than comm_vel, write_data relies on it
  fields_grow = fields_copy = fields_exchange = fields_restart = fields_create = {"rmass", "vfrac"};
  fields_data_atom = {"id", "type", "rmass", "vfrac", "x"};
  fields_data_vel = {"id", "v"};
  bonus_flag = 1;
}

AtomVecMPM::~AtomVecMPM()
{
  points->grow(memory, 0);
}

void AtomVecMPM::process_args(int narg, char **arg)
{
  if (narg > 0)
    error->all(FLERR, "Atom style mpm takes no arguments, found: {}{}", arg[0],
               " (in atom_style hybrid this can be an unknown style)");
  setup_fields();
}

/** The first set-up after read_restart is when LAMMPS drops what no fix has taken from the file.
 *  Fixes of this package come later than this in the set-up. It may be that of another command,
 *  before the input has come to its fixes. */

namespace {
struct Restart : Modify {
  static bool is_left(const Modify &m, int i) { return !(m.*&Restart::used_restart_global)[i]; }
  static const char *id(const Modify &m, int i) { return (m.*&Restart::id_restart_global)[i]; }
  static const char *style(const Modify &m, int i)
  {
    return (m.*&Restart::style_restart_global)[i];
  }
};
}    // namespace

void AtomVecMPM::init()
{
  AtomVec::init();
  std::string left;
  for (int i = 0; i < modify->nfix_restart_global; i++) {
    const std::string style = Restart::style(*modify, i);
    if (Restart::is_left(*modify, i) && (style == "mpm" || utils::strmatch(style, "^mpm/")))
      left += fmt::format("{}fix {} (style {})", left.empty() ? "" : ", ", Restart::id(*modify, i),
                          style);
  }
  if (!left.empty() && comm->me == 0)
    error->warning(
        FLERR,
        "The run that wrote the restart file had {}, and what is in the file of it is lost now: if "
        "it shall go on, define it with the same ID and style directly after read_restart, before "
        "commands that need the whole system, such as delete_atoms, balance, and run",
        left);
}

/** Set local copies of the arrays, also when this is a sub-style of hybrid. Of other sub-styles
 *  that use mass or volume in their own way, only spheres are fine, when they come first. */
void AtomVecMPM::grow_pointers()
{
  rmass = atom->rmass;
  vfrac = atom->vfrac;
  radius = atom->radius;
  points->grow(memory, atom->nmax);

  after_sphere = false;
  auto *hybrid = dynamic_cast<AtomVecHybrid *>(atom->avec);
  if (!hybrid) return;

  bool passed = false;
  for (int k = 0; k < hybrid->nstyles; k++) {
    const std::string style = hybrid->keywords[k];
    const auto &fields = hybrid->styles[k]->fields_data_atom;
    const bool clash = std::count(fields.begin(), fields.end(), "rmass") +
        std::count(fields.begin(), fields.end(), "vfrac");
    if (hybrid->styles[k] == this) {
      passed = true;
    } else if (style == "sphere" || style == "bpm/sphere") {
      if (passed)
        error->all(FLERR, "Atom style mpm must come after {} in atom_style hybrid", style);
      after_sphere = true;
    } else if (clash) {
      error->all(FLERR,
                 "Atom style mpm cannot be combined with atom style {}, which uses the mass or "
                 "volume of atoms in another way",
                 style);
    }
  }
}

static double sphere_volume(double r)
{
  return r > 0.0 ? MathConst::MY_4PI3 * r * r * r : 1.0;
}

/** A new atom is no material point until it is given a volume (all other fields are zero here,
 *  those of sub-styles before this one are set). */
void AtomVecMPM::create_atom_post(int ilocal)
{
  if (!after_sphere) rmass[ilocal] = 1.0;
  points->reset(ilocal);
}

/** F and stress, wherever an atom goes. */
void AtomVecMPM::copy_bonus(int i, int j, int)
{
  std::copy_n(points->F[i], 9, points->F[j]);
  std::copy_n(points->tau[i], 6, points->tau[j]);
}

int AtomVecMPM::pack_exchange_bonus(int i, double *buf)
{
  buf = std::copy_n(points->F[i], 9, buf);
  std::copy_n(points->tau[i], 6, buf);
  return MPMPoints::size;
}

int AtomVecMPM::unpack_exchange_bonus(int i, double *buf)
{
  std::copy_n(buf, 9, points->F[i]);
  std::copy_n(buf + 9, 6, points->tau[i]);
  return MPMPoints::size;
}

// Each atom has a checksum behind what LAMMPS and the fixes write of it. Not in a hybrid style,
// which writes atoms itself.

/** Of all but the length and the image flags, which keyword remap of read_restart changes first. */
static double checksum_of_record(const double *buf, int n)
{
  constexpr int IMAGE = 7;
  return checksum(buf + 1, (IMAGE - 1) * sizeof(double)) -
      checksum(buf + IMAGE + 1, (n - IMAGE - 1) * sizeof(double));
}

int AtomVecMPM::size_restart()
{
  return AtomVec::size_restart() + atom->nlocal;
}

int AtomVecMPM::pack_restart(int i, double *buf)
{
  const int n = AtomVec::pack_restart(i, buf);
  buf[n] = checksum_of_record(buf, n);
  buf[0] = n + 1;
  return n + 1;
}

int AtomVecMPM::unpack_restart(double *buf)
{
  const int n = (int) buf[0] - 1;
  if (n < 11 || buf[n] != checksum_of_record(buf, n))
    error->one(FLERR, Error::NOLASTLINE,
               "The atom with ID {} in the restart file is not what was written: the file was "
               "damaged, or is of another version of this package; take another file",
               (tagint) ubuf(buf[4]).i);
  buf[0] = n;
  AtomVec::unpack_restart(buf);
  buf[0] = n + 1;
  return n + 1;
}

int AtomVecMPM::size_restart_bonus()
{
  return MPMPoints::size * atom->nlocal;
}

double AtomVecMPM::memory_usage_bonus()
{
  return (double) MPMPoints::size * sizeof(double) * atom->nmax;
}

/** Density and volume from the data file to mass. */
void AtomVecMPM::data_atom_post(int ilocal)
{
  const double volume = vfrac[ilocal];
  if (!(volume >= 0.0))
    error->one(FLERR,
               "Invalid volume {} of atom {} in Atoms section of data file: it must be > 0 for a "
               "material point and 0 for other atoms",
               volume, atom->tag[ilocal]);

  if (volume > 0.0) {
    double density = rmass[ilocal];
    if (after_sphere) density /= sphere_volume(radius[ilocal]);
    if (!(density >= 0.0))
      error->one(FLERR,
                 "Invalid density {} of atom {} in Atoms section of data file: it must be > 0, or "
                 "0 for a material point whose mass will come from fix mpm/material",
                 density, atom->tag[ilocal]);
    rmass[ilocal] = density * volume;
  } else if (!after_sphere && !(rmass[ilocal] > 0.0)) {
    error->one(FLERR,
               "Invalid mass {} of atom {} in Atoms section of data file: an atom without volume "
               "is no material point, and its density column is its mass, which must be > 0",
               rmass[ilocal], atom->tag[ilocal]);
  }

  points->reset(ilocal);
}

/** Are points of this rank deformed, which a data file cannot tell? */
static bool any_deformed(Atom *atom)
{
  constexpr double LOST = 1.0e-6;    // strain
  const auto *const points = MPMPoints::get(atom);
  for (int i = 0; points && i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    double strain = std::fabs(points->jacobian(i) - 1.0);
    for (int c = 0; c < 9; c++)
      strain = std::max(strain, std::fabs(points->F[i][c] - (c % 4 == 0 ? 1.0 : 0.0)));
    if (strain > LOST) return true;
  }
  return false;
}

/** Mass to density for AtomVec::pack_data(). It is called for each atom of a rank by itself, so
 *  that the first rank speaks for its own points alone. After a sphere style, rmass is mass /
 *  (volume of the sphere), and radius the diameter. */
void AtomVecMPM::pack_data_pre(int ilocal)
{
  rmass_one = rmass[ilocal];
  if (ilocal == 0 && comm->me == 0 && any_deformed(atom))
    error->warning(FLERR,
                   "A data file has no deformation, stress, and history of material points: after "
                   "read_data these are undeformed; use write_restart to go on");
  if (!(vfrac[ilocal] > 0.0)) return;

  if (after_sphere && rmass_one == 0.0)
    error->one(FLERR,
               "Material point {} has no mass yet, and atom style sphere cannot read such atoms "
               "from a data file: define fix mpm/material before write_data",
               atom->tag[ilocal]);
  const double sphere = after_sphere ? sphere_volume(0.5 * radius[ilocal]) : 1.0;
  rmass[ilocal] = rmass_one * sphere / vfrac[ilocal];
}

/** Index of a property for compute property/atom, -1: unknown. */
int AtomVecMPM::property_atom(const std::string &name)
{
  const auto *const end = std::end(properties), *const found = std::find(properties, end, name);
  return found == end ? -1 : (int) (found - properties);
}

/** Pack a property of the atoms of a group, 0 for those that are no material points. */
void AtomVecMPM::pack_property_atom(int index, double *buf, int nvalues, int groupbit)
{
  for (int i = 0; i < atom->nlocal; i++) {
    double value = 0.0;
    if ((atom->mask[i] & groupbit) && vfrac[i] > 0.0) {
      const double J = points->jacobian(i);
      if (index == VOLUME0)
        value = vfrac[i];
      else if (index == VOLUME)
        value = J * vfrac[i];
      else if (index == JACOBIAN)
        value = J;
      else if (index == DENSITY)
        value = rmass[i] / (J * vfrac[i]);
      else if (index >= STRESS11)
        value = points->tau[i][index - (index < STRESS21 ? STRESS11 : STRESS11 + 3)] / J;
      else
        value = points->F[i][index - F11];
    }
    buf[(bigint) i * nvalues] = value;
  }
}
