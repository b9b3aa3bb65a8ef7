/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "create/create_points.h"

#include "atom.h"
#include "atom_vec.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "create/create_points_table.h"
#include "create/mpm_point_columns.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_interfaces.h"
#include "fix.h"
#include "group.h"
#include "image/body.h"
#include "irregular.h"
#include "lattice.h"
#include "modify.h"
#include "region.h"
#include "walls/mpm_region_cut.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double TOLERANCE = 1.0e-6;    // in spacings, for positions that coincide
static constexpr bigint SHARE = 1 << 11;    // sites a rank looks at before points are sent, or ...
static constexpr bigint PART = 64;          // ... 1/PART of those it has looked at, if that is more
static constexpr bigint GROWTH = 16;        // room for points grows by 1/GROWTH at least

CreatePoints::CreatePoints(LAMMPS *lmp) : Command(lmp) {}

CreatePoints::~CreatePoints() = default;

/** Lengths of regions are in units of the lattice command, if there is one. */
void CreatePoints::check_units_of_region() const
{
  const Region &r = *region;
  if (!fix || !r.scaleflag || !r.bboxflag || !domain->lattice || domain->lattice->xlattice == 1.0)
    return;
  const double size[3] = {r.extent_xhi - r.extent_xlo, r.extent_yhi - r.extent_ylo,
                          r.extent_zhi - r.extent_zlo};
  const double largest = *std::max_element(size, size + domain->dimension);
  if (largest < fix->lattice.h && comm->me == 0)
    error->warning(
        FLERR,
        "Create_points: region {} is only {:.4g} wide, less than a cell of fix mpm {}, as "
        "its lengths are in units of the lattice command: give it the keyword units box",
        r.id, largest, fix->id());
}

/** Is a body in this region round somewhere? A round hole does not count. */
static bool is_round(const Region &region)
{
  static const std::set<std::string> styles = {"sphere", "cylinder", "cone", "ellipsoid",
                                               "mpm/mesh"};
  if (region.nregion == 1) return region.interior && styles.count(region.style);
  return std::any_of(region.reglist, region.reglist + region.nregion, [](Region *part) {
    return is_round(*part);
  });
}

/** What is known of a round body is that of the last one of its type. */
void CreatePoints::note_round() const
{
  auto &round = MPMPoints::get(atom)->round;
  round.resize(atom->ntypes + 1);
  const Region &r = *region;
  double width = std::min(r.extent_xhi - r.extent_xlo, r.extent_yhi - r.extent_ylo);
  if (domain->dimension == 3) width = std::min(width, r.extent_zhi - r.extent_zlo);
  round[type] = {r.bboxflag ? 0.5 * width : HUGE_VAL, !cut};
}

void CreatePoints::command(int narg, char **arg)
{
  if (domain->box_exist == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points command before the simulation box is defined: use create_box or "
               "read_data first");
  if (!atom->style_match("mpm"))
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points needs atom_style mpm, alone or in atom_style hybrid, but the atom "
               "style is {}",
               atom->atom_style);
  if (domain->triclinic)
    error->all(FLERR, Error::NOLASTLINE, "Create_points needs an orthogonal simulation box");
  if (modify->nfix_restart_peratom)
    error->all(FLERR, Error::NOLASTLINE,
               "Cannot create_points after reading a restart file with per-atom info of fixes: "
               "define these fixes and use run 0 first");

  const int iarg = 0;
  require_arguments(lmp, "create_points", narg, 0,
                    {"type", "one of region box image mesh elements table"});
  type = utils::expand_type_int(FLERR, arg[0], Atom::ATOM, lmp);
  if (type < 1 || type > atom->ntypes)
    error->all(FLERR, iarg, "Invalid atom type {} in create_points command, the box has {} type{}",
               arg[0], atom->ntypes, atom->ntypes > 1 ? "s" : "");
  if (strcmp(arg[1], "mesh") == 0 || strcmp(arg[1], "elements") == 0) {
    parse_mesh(narg, arg);
  } else if (strcmp(arg[1], "table") == 0) {
    parse_table(narg, arg);
  } else {
    if (strcmp(arg[1], "image") == 0)
      parse_image(narg, arg);
    else
      parse(narg, arg);
    find_ranges();
    if (cut) begin_cut();
    check_outside();
    check_overlap();
  }

  MPI_Barrier(world);
  const double start = platform::walltime();

  // as at the beginning of Comm::exchange(): new points overwrite ghosts

  if (atom->map_style != Atom::MAP_NONE) atom->map_clear();
  atom->nghost = 0;
  atom->avec->clear_bonus();

  const bigint natoms_previous = atom->natoms;
  const int nlocal_previous = atom->nlocal;
  const bigint npoints = mesh ? make_mesh_points()
      : table                 ? make_table_points()
      : relax                 ? make_relaxed_points()
                              : make_points();

  atom->data_fix_compute_variable(nlocal_previous, atom->nlocal);
  if (mesh) mesh->set_domains(nlocal_previous);
  set_fields(nlocal_previous);
  set_columns(nlocal_previous);

  bigint nblocal = atom->nlocal;
  MPI_Allreduce(&nblocal, &atom->natoms, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (atom->natoms < 0 || atom->natoms >= MAXBIGINT)
    error->all(FLERR, Error::NOLASTLINE, "Too many total atoms");
  if (region) check_units_of_region();
  if (region && is_round(*region)) note_round();
  if (npoints == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points made no points: no site of the lattice with spacing {:.8g} is inside "
               "the {} and the box; use a finer spacing or check the {}",
               *std::max_element(spacing, spacing + domain->dimension),
               image ? "bodies of the image" : "region", image ? "threshold" : "region");
  if (atom->natoms != natoms_previous + npoints)
    error->all(FLERR, Error::NOLASTLINE, "Create_points made {} points at {} sites",
               atom->natoms - natoms_previous, npoints);
  atom->tag_check();

  if (atom->map_style != Atom::MAP_NONE) {
    atom->map_init();
    atom->map_set();
  }

  double made = 0.0, all_made = 0.0;
  for (int i = nlocal_previous; i < atom->nlocal; i++) made += atom->vfrac[i];
  MPI_Reduce(&made, &all_made, 1, MPI_DOUBLE, MPI_SUM, 0, world);
  const std::string types = mesh ? "type" + mesh->fields->types() : types_made(nlocal_previous);
  const bool uneven = cut || table || split_variable >= 0 || (image && image->surface);
  if (comm->me == 0) {
    const bool flat = domain->dimension == 2;
    utils::logmesg(lmp, "Created {} material points of {}\n", npoints, types);
    if (!mesh && !table)
      utils::logmesg(lmp, "  spacing = {:.8g} {:.8g}{}\n", spacing[0], spacing[1],
                     flat ? "" : fmt::format(" {:.8g}", spacing[2]));
    if (fix && fix->options.axisymmetric)
      utils::logmesg(
          lmp, "  area = {:.8g} per {}, volume = {:.8g} in total (all around the axis)\n", volume,
          cut          ? "whole cell of a point"
              : uneven ? "site"
                       : "point",
          all_made);
    else
      utils::logmesg(lmp, "  volume = {:.8g} {}, {:.8g} in total{}\n",
                     uneven ? all_made / npoints : volume,
                     mesh || uneven ? "on average" : "per point",
                     uneven ? all_made : npoints * volume, flat ? " (per unit thickness)" : "");
    utils::logmesg(lmp, "  create_points CPU = {:.3f} seconds\n", platform::walltime() - start);
  }
}

Options CreatePointsOptions::declare(int dim, bool has_radius)
{
  Options o("create_points");
  add_to(o, dim);
  o.refuse([=] {
    return rules(has_radius);
  });
  return o;
}

void CreatePointsOptions::add_to(Options &o, int dim)
{
  using namespace option;
  o.add("ppc",
        {one_or_axes(ppc, dim, "N Nx Ny Nz", {1, MAX_PPC, true}, "",
                     "number of points along each axis of a cell of fix mpm",
                     "number of points along x, y, z")})
      .standard("2");
  o.add("spacing",
        {one_or_axes(spacing, dim, "D Dx Dy Dz", POSITIVE, "distance",
                     "distance between neighboring points", "distance along x, y, z")})
      .standard("");
  o.add("fix", {text(fix_id, "fix-ID", "ID of the fix mpm whose lattice is used")})
      .standard("the only fix mpm");
  o.add("jitter",
        {number(jitter, "fraction", {0.0, 0.5, true}, "",
                "largest displacement along each axis, in units of the spacing"),
         integer(seed, "seed", POSITIVE, "random number seed")})
      .standard("none");
  o.add("overlap", {yes_no(allow_overlap)},
        "allow new points in places that have material points already");
  o.add("outside", {word(ignore_outside, {{"error", false}, {"ignore", true}})},
        "what to do when the region reaches beyond the box");
  o.add("diameter",
        {number(diameter, "D", POSITIVE, "distance",
                "diameter of the points in contact with grains")})
      .standard("edge of a cube (2d: square) of the volume");
  o.add("share",
        {number(share, "share", {0.0, 1.0, true}, "",
                "share of its site's volume that each point gets")});
  o.add("cut", {yes_no(cut)},
        "points at the surface of the region get only the part of their cell that is inside");
  o.add("relax",
        {integer(relax, "N", {0, 10000, true},
                 "number of iterations that move points to follow the surface of the region with "
                 "equal volumes")});
  std::vector<OptionValue> words = {
      text(split, "v_n",
           "equal-style variable with the number of points along each axis of a site"),
      text(split_place[0], "v_x",
           "internal-style variable that receives the x coordinate of the site"),
      text(split_place[1], "v_y",
           "internal-style variable that receives the y coordinate of the site")};
  if (dim == 3)
    words.push_back(text(split_place[2], "v_z",
                         "internal-style variable that receives the z coordinate of the site"));
  o.add("split", words).standard("one point per site");
  o.add("group",
        {text(group_id, "group-ID",
              "group that the points join; it is created if it does not exist")})
      .standard("all");
}

OptionRules CreatePointsOptions::rules(bool has_radius) const
{
  return {
      {share == 0.0, "share", "must be positive: {share}"},
      {cut && jitter > 0.0, "cut",
       "puts points at the center of what is inside of the region, from where jitter would move "
       "them: use one of the two"},
      {relax > 0 && jitter > 0.0, "relax",
       "puts points at the centers of their cells, from where jitter would move them: use one of "
       "the two"},
      {!split.empty() && cut, "split",
       "divides whole sites, and cut has parts of them: use one of the two"},
      {!split.empty() && jitter > 0.0, "split", "has no jitter: use one of the two"},
      {ppc[0] > 0, "spacing", "and ppc cannot be given together: use either of them"},
      {!has_radius, "diameter", "needs atom_style hybrid sphere mpm"}};
}

void CreatePoints::parse(int narg, char **arg)
{
  int iarg = 2;
  if (strcmp(arg[1], "region") == 0) {
    require_arguments(lmp, "create_points region", narg, 2, {"region-ID"});
    region = domain->get_region_by_id(arg[2]);
    if (!region) error->all(FLERR, 2, "Create_points region {} does not exist", arg[2]);
    region->init();
    region->prematch();
    iarg = 3;
  } else if (strcmp(arg[1], "box") != 0) {
    error->all(
        FLERR, 1,
        "Unknown create_points option {}: expected region, box, image, mesh, elements, or table",
        arg[1]);
  }

  Options options = declare(domain->dimension, atom->radius_flag);
  read_options(lmp, options, narg, arg, iarg);
  place_sites(options);
}

/** The lattice of sites, and what all points have in common. */
void CreatePoints::place_sites(const Options &options)
{
  const int dim = domain->dimension;
  find_group(options, group_id);
  if (relax && (image || !region))
    error->all(FLERR, options.where("relax"),
               "Create_points keyword relax is about the surface of a region: use style region");
  if (cut && (image || !region))
    error->all(FLERR, options.where("cut"),
               "Create_points keyword cut is about the surface of a region: use style region");
  if (!fix_id.empty()) {
    auto *ifix = modify->get_fix_by_id(fix_id);
    const int where = options.where("fix") + 1;
    if (!ifix) error->all(FLERR, where, "Create_points fix {} does not exist", fix_id);
    fix = MPMField::find(lmp, fix_id);
    if (!fix)
      error->all(FLERR, where,
                 "Create_points fix {} is a fix {}, not a fix mpm: use the keyword spacing instead",
                 fix_id, ifix->style);
  }

  // lattice of sites

  const bool use_spacing = options.given("spacing");
  find_lattice();
  if (ppc[0] == 0) std::fill(ppc, ppc + 3, 2);
  if (sites_on_pixels) {
    for (int d = 0; d < dim; d++) {
      origin[d] = image->lo[d];
      spacing[d] = image->pixel[d];
    }
  } else if (fix) {
    for (int d = 0; d < dim; d++) {
      origin[d] = fix->lattice.origin[d];
      if (!use_spacing) spacing[d] = fix->lattice.h / ppc[d];
    }
  } else {
    const auto flows = find_fixes<MPMFluid>(lmp);
    if (!use_spacing && !flows.empty())
      error->all(FLERR, Error::NOPOINTER,
                 "Create_points ppc refers to the lattice of a fix mpm, and not to that of a flow: "
                 "use create_points spacing {:.8g}",
                 0.5 * flows[0]->spacing());
    if (!use_spacing)
      error->all(FLERR, Error::NOPOINTER,
                 "Create_points ppc refers to the lattice of a fix mpm, "
                 "but there is none: define fix mpm first, or use create_points spacing");
    for (int d = 0; d < dim; d++) origin[d] = domain->boxlo[d];
  }

  // 2d: one site at z = 0, volumes per unit thickness

  if (dim == 2) {
    spacing[2] = 1.0;
    origin[2] = -0.5;
  }
  volume = share * spacing[0] * spacing[1] * spacing[2];
  if (!std::isnormal(volume))
    error->all(FLERR, Error::NOPOINTER, "Create_points spacing gives points of volume {}", volume);

  for (int d = 0; d < dim; d++) {
    if (fix && comm->me == 0 && spacing[d] > fix->lattice.h * (1.0 + TOLERANCE))
      error->warning(FLERR,
                     "Create_points spacing {:.8g} along {} is wider than the cells of fix "
                     "{} ({:.8g}): there will be cells without points inside the body",
                     spacing[d], "xyz"[d], fix -> id(), fix -> lattice.h);
  }
  find_split(options);
  cut = cut || relax;
}

void CreatePoints::find_group(const Options &options, const std::string &name)
{
  if (name.empty()) return;
  const int igroup = group->find_or_create(name.c_str());
  if (group->dynamic[igroup])
    error->all(
        FLERR, options.where("group") + 1,
        "Create_points group {} is dynamic: its rule decides what is in it; use another group",
        name);
  group_bits = group->bitmask[igroup];
}

/** Looks at all sites once, in the order of their numbers, which the IDs of points follow. Returns
 *  the number of points. */
bigint CreatePoints::make_points()
{
  Range range[3];
  const bigint n = ranges_in_box(range);

  const tagint maxtag = largest_tag();
  std::vector<Site> made;
  bigint npoints = 0;

  bigint share;
  for (bigint base = 0; base < n; base += share * comm->nprocs) {

    // my share of the next sites. It is small: freed memory of the size of arrays would make the C
    // library keep those in its heap, where growing arrays leave holes

    share = std::max(SHARE, base / (PART * comm->nprocs));
    made.clear();
    const bigint first = std::min(base + share * comm->me, n);
    for_sites(range, first, std::min(first + share, n), [&](const bigint *s) {
      Site site;
      if (cut && cut_site(s, site)) made.push_back(site);
      if (split_variable >= 0) make_parts(s, made);
      const double part = cut || split_variable >= 0 ? 0.0 : volume_fraction(s);
      if (!(part > 0.0)) return;
      made.push_back({{}, part * volume, 0});
      if (image) look_at_image(s, made.back());
      point_position(s, made.back().x);
    });

    // IDs

    bigint nmade = made.size(), before = 0, all = 0;
    MPI_Scan(&nmade, &before, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    MPI_Allreduce(&nmade, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    before += npoints - nmade;
    npoints += all;
    check_tags(maxtag, npoints);
    for (bigint k = 0; k < nmade; k++) made[k].tag = atom->tag_enable ? maxtag + before + k + 1 : 0;

    send_and_make(made);
  }
  bigint outside = 0;
  MPI_Allreduce(&beyond_box, &outside, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (outside && !ignore_outside)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points split: {} points of sites at faces of the box would be outside of "
               "it; let these faces "
               "be faces of cells, or use create_points keyword outside ignore",
               outside);
  return npoints;
}

tagint CreatePoints::largest_tag() const
{
  tagint mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++) mine = std::max(mine, atom->tag[i]);
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  return all;
}

void CreatePoints::check_tags(tagint largest, bigint nmore) const
{
  if (atom->tag_enable && largest + nmore >= MAXTAGINT)
    error->all(FLERR, Error::NOLASTLINE, "New atom IDs exceed the maximum allowed ID {}",
               MAXTAGINT);
}

/** Sends sites to their owners, where they arrive in the same order in each run. */
void CreatePoints::send_and_make(std::vector<Site> &made)
{
  std::vector<Site> received;
  if (comm->nprocs == 1) {
    received.swap(made);
  } else {
    Irregular irregular(lmp);
    comm->coord2proc_setup();
    std::vector<int> owners;
    for (auto &site : made) owners.push_back(owner(site.x));
    received.resize(irregular.create_data((int) made.size(), owners.data(), 1));
    irregular.exchange_data((char *) made.data(), sizeof(Site), (char *) received.data());
    irregular.destroy_data();
  }

  const bigint need = (bigint) atom->nlocal + received.size();
  if (need > atom->nmax) {
    const bigint room = atom->nmax + (bigint) atom->nmax / GROWTH;
    atom->avec->grow(atom->avec->roundup(room < MAXSMALLINT / 2 ? std::max(need, room) : need));
  }
  for (const auto &site : received) make_point(site);
}

int CreatePoints::owner(double *x) const
{
  int unused[3];
  return comm->nprocs == 1 ? 0 : comm->coord2proc(x, unused[0], unused[1], unused[2]);
}

void CreatePoints::make_point(Site site)
{
  atom->avec->create_atom(site.type ? site.type : type, site.x);
  if (!fields.empty()) grays.push_back(site.gray);

  const int i = atom->nlocal - 1;
  atom->tag[i] = site.tag;
  atom->image[i] = site.image;
  atom->mask[i] |= group_bits;
  atom->vfrac[i] = site.volume * (fix ? fix->frame->circle(site.x[0]) : 1.0);
  atom->rmass[i] = 0.0;    // not known yet, see fix mpm/material
  const double edge = domain->dimension == 3 ? cbrt(site.volume) : sqrt(site.volume);
  if (atom->radius_flag) atom->radius[i] = 0.5 * (diameter > 0.0 ? diameter : edge);
}
