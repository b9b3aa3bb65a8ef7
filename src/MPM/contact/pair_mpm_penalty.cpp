/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/pair_mpm_penalty.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_lists.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "contact/fix_mpm_contact.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "force.h"
#include "loads/fix_mpm_emit.h"
#include "material/material.h"
#include "math/coulomb.h"
#include "math_const.h"
#include "math_extra.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int NOTHING = -1;    // field of an atom that is no point

void PairMPMPenalty::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);
  if (neighbor->ago == 0 || (int) radius.size() < atom->nmax) find_pairs();
  for (const int i : near) radius[i] = current_radius(i);
  if (heats) {
    effusivity.resize(atom->nmax);
    heat.assign(atom->nmax, 0.0);
    for (const int i : near) effusivity[i] = effusivity_of(i);
  }
  comm->forward_comm(this);

  double **x = atom->x, **v = atom->v, **f = atom->f;
  const int *type = atom->type;
  const int nlocal = atom->nlocal, newton_pair = force->newton_pair;
  const bool flat = domain->dimension == 2;
  const double to_force = 1.0 / force->nktv2p;
  double contacts = 0.0, dissipated = 0.0;
  int deep = -1;    // a point that another one has entered

  for (const auto &pair : pairs) {
    const int i = pair.first, j = pair.second;
    double d[3];
    MathExtra::sub3(x[i], x[j], d);
    const double rsq = MathExtra::lensq3(d), reach = radius[i] + radius[j];
    if (rsq >= reach * reach || rsq == 0.0 || radius[i] == 0.0 || radius[j] == 0.0) continue;

    const Coeff &c = coeff_of(type[i], type[j]);
    const double r = sqrt(rsq), overlap = reach - r;
    const double width = 2.0 * std::min(radius[i], radius[j]);
    if (overlap > 0.5 * width) deep = i;
    const double depth = rings ? MathConst::MY_PI * (x[i][0] + x[j][0]) : (flat ? 1.0 : width);
    const double stiffness = c.modulus * to_force * width * depth / reach;
    const double n[3] = {d[0] / r, d[1] / r, d[2] / r};
    double normal = stiffness * overlap, power = 0.0;
    double force_i[3] = {0.0, 0.0, 0.0};

    if (c.damping > 0.0 || c.friction > 0.0) {
      double u[3];
      MathExtra::sub3(v[i], v[j], u);
      const double un = MathExtra::dot3(u, n);
      if (c.damping > 0.0) {
        const double m = force->mvv2e * mass[i] * mass[j] / (mass[i] + mass[j]);
        const double damper = -2.0 * c.damping * sqrt(stiffness * m) * un;
        const double elastic = normal;
        normal = std::max(0.0, elastic + damper);    // bodies do not pull on each other
        power -= (normal - elastic) * un;
      }
      if (c.friction > 0.0) {
        MathExtra::scaleadd3(-un, n, u, u);
        const double slip = MathExtra::len3(u);
        const double drag = CoulombFriction{c.friction}.drag(slip, normal, c.slip);
        MathExtra::scale3(-drag, u, force_i);
        power += drag * slip * slip;
      }
    }

    for (int k = 0; k < 3; k++) {
      force_i[k] += normal * n[k];
      f[i][k] += force_i[k];
      if (newton_pair || j < nlocal) f[j][k] -= force_i[k];
    }
    if (rings) {    // the energy is that of a ring, which is shorter nearer to the axis
      const double inward = 0.5 * stiffness * overlap * overlap / (x[i][0] + x[j][0]);
      f[i][0] -= inward;
      if (newton_pair || j < nlocal) f[j][0] -= inward;
    }
    const double share = newton_pair || j < nlocal ? 1.0 : 0.5;
    contacts += share;
    dissipated += share * power;
    if (heats && power > 0.0) {
      const double both = effusivity[i] + effusivity[j];
      if (both > 0.0) heat[i] += power * effusivity[i] / both;
      if (both > 0.0 && share == 1.0) heat[j] += power * effusivity[j] / both;
    }
    if (evflag)
      ev_tally_xyz(i, j, nlocal, newton_pair, eflag ? 0.5 * stiffness * overlap * overlap : 0.0,
                   0.0, force_i[0], force_i[1], force_i[2], d[0], d[1], d[2]);
  }

  if (deep >= 0 && !warned_deep) {
    warned_deep = true;
    error->warning(FLERR,
                   "Pair style mpm/penalty: point {} and one of another field overlap by more than "
                   "a radius at step {}: bodies will penetrate each other, unless their pair_coeff "
                   "has a larger modulus",
                   atom->tag[deep], update->ntimestep);
  }
  if (heats && newton_pair) comm->reverse_comm(this);
  pvector[0] = contacts;
  pvector[1] = dissipated;
  if (vflag_fdotr) virial_fdotr_compute();
}

/** Once per neighbor list: of its pairs those of different fields, and whose radii are needed. */
void PairMPMPenalty::find_pairs()
{
  const int nlocal = atom->nlocal, nall = nlocal + atom->nghost, ntypes = atom->ntypes;
  const int nfields = (int) fields.size();
  radius.assign(atom->nmax, 0.0);
  if (damped) {
    mass.resize(atom->nmax);
    std::copy_n(atom->rmass, nlocal, mass.begin());
  }

  std::vector<int> field(nall);
  for (int i = 0; i < nall; i++) field[i] = field_of(i);
  for (int i = 0; i < nlocal; i++) {
    if (field[i] == NOTHING) continue;
    const int t = atom->type[i];
    if (!present[field[i] * (ntypes + 1) + t] || atom->vfrac[i] > most_volume[t])
      error->one(FLERR, Error::NOLASTLINE,
                 "Pair style mpm/penalty: point {} has changed its type or field, or is larger "
                 "than the points of its type were at the start of the run: begin a new run after "
                 "such changes",
                 atom->tag[i]);
  }

  pairs.clear();
  near.clear();
  std::vector<char> in_pair(nlocal, 0);
  double same = 0.0, all = 0.0;
  for (int ii = 0; ii < list->inum; ii++) {
    const int i = list->ilist[ii];
    all += list->numneigh[i];
    if (field[i] == NOTHING) continue;
    for (int jj = 0; jj < list->numneigh[i]; jj++) {
      const int j = list->firstneigh[i][jj] & NEIGHMASK;
      if (field[j] == NOTHING) continue;
      same += field[i] == field[j];
      if (coupled[field[i] * nfields + field[j]]) continue;
      if (coeff_of(atom->type[i], atom->type[j]).modulus == 0.0) continue;
      pairs.emplace_back(i, j);
      in_pair[i] = 1;
      if (j < nlocal) in_pair[j] = 1;
    }
  }
  for (int i = 0; i < nlocal; i++)
    if (in_pair[i]) near.push_back(i);
  if (look) warn_about_list(same, all);
}

/** Lists full of points of the same body make all of LAMMPS slow. */
void PairMPMPenalty::warn_about_list(double same, double all)
{
  look = false;
  double mine[2] = {same, all}, sum[2];
  MPI_Allreduce(mine, sum, 2, MPI_DOUBLE, MPI_SUM, world);
  if (comm->me || sum[0] < 0.5 * sum[1] || sum[0] < 1000.0) return;
  error->warning(
      FLERR,
      "Pair style mpm/penalty: {:.0f} of {:.0f} pairs in the neighbor list are of points of one "
      "field, which costs much time and memory: give each field atom types of its own, and with "
      "neighbor multi or pair hybrid exclude pairs within each field with neigh_modify exclude "
      "type I I",
      sum[0], sum[1]);
}

/** Field of a local or ghost atom by its group; ghosts that are no points have radius 0. */
int PairMPMPenalty::field_of(int i) const
{
  if (i < atom->nlocal && atom->vfrac[i] == 0.0) return NOTHING;
  for (std::size_t k = 0; k < fields.size(); k++)
    if (atom->mask[i] & fields[k]->fix.groupbit) return (int) k;
  return NOTHING;
}

/** Half the spacing of points of this volume (2d: area; a ring: volume over its circle). */
double PairMPMPenalty::initial_radius(int i) const
{
  double V = atom->vfrac[i];
  if (rings) V /= fields[0]->frame->circle(atom->x[i][0] / points->F[i][8]);
  return 0.5 * (domain->dimension == 2 ? sqrt(V) : cbrt(V));
}

double PairMPMPenalty::current_radius(int i)
{
  if (atom->vfrac[i] == 0.0) return 0.0;
  const double J = points->jacobian(i) / (rings ? points->F[i][8] : 1.0);
  double factor = domain->dimension == 2 ? sqrt(J) : cbrt(J);
  if (!(factor <= growth)) {
    factor = growth;
    if (!warned)
      error->warning(FLERR,
                     "Pair style mpm/penalty: point {} has expanded by J = {:.6g}, its radius "
                     "stays at {} times the initial one (pair_style mpm/penalty growth)",
                     atom->tag[i], J, growth);
    warned = true;
  }
  const double now = factor * initial_radius(i);
  // beyond the cutoff only where x/F_zz of a ring is not its initial radius any more
  return rings ? std::min(now, growth * (1.0 + 1e-10) * largest[atom->type[i]]) : now;
}

/** As in MPMFrictionHeat, with the mean conductivity along all axes; 0: its material does not
 *  conduct. */
double PairMPMPenalty::effusivity_of(int i) const
{
  const int field = field_of(i);
  const auto *const fix = field == NOTHING ? nullptr : fields[field]->material_of(i);
  if (!fix || !fix->material->conducts()) return 0.0;
  const Conduction c = fix->material->conduction(fix->history[i]);
  const double k = c.orthotropic ? (c.conductivity + c.across[0] + c.across[1]) / 3.0
                                 : c.conductivity;
  return sqrt(k * fix->material->density() * c.capacity);
}

/** Radii change in each step, and so may effusivities; masses do not, but this is the only message.
 */
int PairMPMPenalty::pack_forward_comm(int n, int *list, double *buf, int, int *)
{
  int m = 0;
  for (int k = 0; k < n; k++) {
    const int j = list[k];
    buf[m++] = j < atom->nlocal ? current_radius(j) : radius[j];
    if (damped) buf[m++] = mass[j];
    if (heats) buf[m++] = j < atom->nlocal ? effusivity_of(j) : effusivity[j];
  }
  return m;
}

void PairMPMPenalty::unpack_forward_comm(int n, int first, double *buf)
{
  int m = 0;
  for (int i = first; i < first + n; i++) {
    radius[i] = buf[m++];
    if (damped) mass[i] = buf[m++];
    if (heats) effusivity[i] = buf[m++];
  }
}

/** Heat of ghosts. */
int PairMPMPenalty::pack_reverse_comm(int n, int first, double *buf)
{
  std::copy_n(heat.begin() + first, n, buf);
  return n;
}

void PairMPMPenalty::unpack_reverse_comm(int n, int *list, double *buf)
{
  for (int k = 0; k < n; k++) heat[list[k]] += buf[k];
}

/** pair_style mpm/penalty keyword value ... */
Options MPMPenaltyOptions::declare()
{
  using namespace option;
  Options o("pair_style mpm/penalty");
  o.add("growth",
        {number(growth, "factor", AT_LEAST_ONE, "1",
                "largest radius of a point, in units of its initial radius")});
  return o;
}

void PairMPMPenalty::settings(int narg, char **arg)
{
  growth = 1.2;
  Options options = declare();
  read_options(lmp, options, narg, arg, 0);
}

/** pair_coeff I J modulus keyword values ... */
Options MPMPenaltyCoeff::declare()
{
  using namespace option;
  Options o("pair_coeff mpm/penalty");
  o.argument(number(modulus, "modulus", NOT_NEGATIVE));
  o.add("friction",
        {number(friction, "mu", NOT_NEGATIVE, "1", "coefficient of Coulomb friction"),
         number(slip, "slip", POSITIVE, "velocity",
                "sliding velocity above which friction is full")})
      .standard("0");
  o.add("damping",
        {number(damping, "zeta", NOT_NEGATIVE, "1",
                "damping of a contact between two points, 1 = critical")});
  return o;
}

/** Which fields and types there are, and how large their points. */
void PairMPMPenalty::init_style()
{
  points = MPMPoints::get(atom);
  if (!points)
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/penalty requires material points: use atom_style mpm, or hybrid "
               "with mpm");
  fields = MPMField::all(lmp);
  if (fields.size() < 2)
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/penalty acts between fields, but there {}: give each body a fix mpm",
               fields.empty() ? "is no fix mpm" : "is only one fix mpm");

  rings = fields[0]->options.axisymmetric;    // all fields are, or none

  const std::size_t nfields = fields.size(), n = atom->ntypes + 1;
  coupled.assign(nfields * nfields, 0);
  for (std::size_t a = 0; a < nfields; a++)
    for (std::size_t b = 0; b < nfields; b++) {
      coupled[a * nfields + b] = a == b;
      for (auto *fix : modify->get_fix_by_style("^mpm/contact$"))
        if (dynamic_cast<FixMPMContact *>(fix)->couples(fields[a]->id(), fields[b]->id()))
          coupled[a * nfields + b] = 1;
    }

  std::vector<char> mine(nfields * n, 0);
  std::vector<double> mine_largest(n, 0.0), mine_volume(n, 0.0);
  for (int i = 0; i < atom->nlocal; i++) {
    const int k = field_of(i);
    if (k == NOTHING) continue;
    mine[k * n + atom->type[i]] = 1;
    mine_largest[atom->type[i]] = std::max(mine_largest[atom->type[i]], initial_radius(i));
    mine_volume[atom->type[i]] = std::max(mine_volume[atom->type[i]], atom->vfrac[i]);
  }
  // an inlet is filled after this, and its type may have no points before
  for (const auto *inlet : find_fixes<FixMPMEmit>(lmp))
    for (std::size_t k = 0; k < nfields; k++) {
      if (!inlet->emits_into(*fields[k])) continue;
      const int type = inlet->type_of_points();
      const double spacing = inlet->largest_spacing(*fields[k]);
      mine[k * n + type] = 1;
      mine_largest[type] = std::max(mine_largest[type], 0.5 * spacing);
      mine_volume[type] = rings ? std::numeric_limits<double>::max()
                                : std::max(mine_volume[type], pow(spacing, domain->dimension));
    }
  present.resize(mine.size());
  largest.resize(n);
  most_volume.resize(n);
  MPI_Allreduce(mine.data(), present.data(), (int) mine.size(), MPI_CHAR, MPI_MAX, world);
  MPI_Allreduce(mine_largest.data(), largest.data(), (int) n, MPI_DOUBLE, MPI_MAX, world);
  MPI_Allreduce(mine_volume.data(), most_volume.data(), (int) n, MPI_DOUBLE, MPI_MAX, world);

  bool velocities = false;
  damped = false;
  for (const auto &c : coeffs) {
    velocities = velocities || c.friction > 0.0 || c.damping > 0.0;
    damped = damped || c.damping > 0.0;
  }
  if (velocities && !comm->ghost_velocity)
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/penalty with friction or damping needs the velocities of ghost "
               "atoms: use comm_modify vel yes");
  heats = false;
  heat.clear();
  comm_forward = damped ? 3 : 2;    // at the most: radius, mass, and effusivity
  comm_reverse = 1;
  radius.clear();
  look = true;
  warned = warned_deep = false;

  neighbor->add_request(this);
}

bool PairMPMPenalty::couples(const std::string &one, const std::string &two)
{
  const std::size_t nfields = fields.size(), n = atom->ntypes + 1;
  for (std::size_t a = 0; a < nfields; a++)
    for (std::size_t b = 0; b < nfields; b++) {
      if (fields[a]->id() != one || fields[b]->id() != two || coupled[a * nfields + b]) continue;
      for (int i = 1; i < (int) n; i++)
        for (int j = 1; j < (int) n; j++)
          if (present[a * n + i] && present[b * n + j] && coeff_of(i, j).modulus > 0.0) return true;
    }
  return false;
}

/** No cutoff, and no pairs in the neighbor list, for types that do not meet. */
double PairMPMPenalty::init_one(int i, int j)
{
  const Coeff &c = coeff_of(i, j);
  const double reach = growth * (largest[i] + largest[j]);
  const std::size_t nfields = fields.size(), n = atom->ntypes + 1;
  for (std::size_t a = 0; a < nfields; a++)
    for (std::size_t b = 0; b < nfields; b++) {
      if (coupled[a * nfields + b] || !present[a * n + i] || !present[b * n + j]) continue;
      if (!c.set)
        error->all(FLERR, Error::NOLASTLINE,
                   "Pair style mpm/penalty has no pair_coeff for types {} and {}, but fields {} "
                   "and {} have such points: give one, with modulus 0 if they shall not touch",
                   i, j, fields[a]->id(), fields[b]->id());
      if (c.modulus > 0.0) return reach;
    }

  // lists by collection make a single bin of a collection without a cutoff
  return i == j && neighbor->style == Neighbor::MULTI ? reach : 0.0;
}

void PairMPMPenalty::write_restart_settings(FILE *fp)
{
  fwrite(&growth, sizeof(double), 1, fp);
}

void PairMPMPenalty::read_restart_settings(FILE *fp)
{
  if (comm->me == 0) utils::sfread(FLERR, &growth, sizeof(double), 1, fp, nullptr, error);
  MPI_Bcast(&growth, 1, MPI_DOUBLE, 0, world);
}

double PairMPMPenalty::memory_usage()
{
  return MPMPair::memory_usage() + bytes_of(radius, mass, effusivity, heat, near);
}
