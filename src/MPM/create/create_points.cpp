/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "create/create_points.h"

#include "atom.h"
#include "atom_vec.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "create/create_points_table.h"
#include "create/mpm_point_columns.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "fix.h"
#include "group.h"
#include "image/body.h"
#include "input.h"
#include "irregular.h"
#include "math/random.h"
#include "math_extra.h"
#include "mesh/element.h"
#include "modify.h"
#include "region.h"
#include "transfer/cpdi.h"
#include "variable.h"
#include "walls/mpm_region_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double TOLERANCE = 1.0e-6;       // in spacings, for positions that coincide
static constexpr double INFINITE = 1.0e19;        // bounds of regions beyond it are INF
static constexpr double MAX_INDEX = 1.0e15;       // largest index of a lattice site
static constexpr double MAX_SITES = 9.0e18;       // most sites that a command looks at
static constexpr bigint MAX_COUNT = 200000000;    // sites per rank looked at outside the box
static constexpr bigint SHARE = 1 << 11;    // sites a rank looks at before points are sent, or ...
static constexpr bigint PART = 64;          // ... 1/PART of those it has looked at, if that is more
static constexpr bigint GROWTH = 16;        // room for points grows by 1/GROWTH at least

static const char axis_name[] = "xyz";

/* ---------------------------------------------------------------------- */

CreatePoints::CreatePoints(LAMMPS *lmp) : Command(lmp) {}
CreatePoints::~CreatePoints() = default;

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
  if (narg < 2) utils::missing_cmd_args(FLERR, "create_points", error);
  type = utils::expand_type_int(FLERR, arg[0], Atom::ATOM, lmp);
  if (type < 1 || type > atom->ntypes)
    error->all(FLERR, iarg, "Invalid atom type {} in create_points command, the box has {} type{}",
               arg[0], atom->ntypes, atom->ntypes > 1 ? "s" : "");
  const bool mesh = strcmp(arg[1], "mesh") == 0 || strcmp(arg[1], "elements") == 0;
  if (mesh) {
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
  set_domains(nlocal_previous);
  set_fields(nlocal_previous);
  set_columns(nlocal_previous);

  bigint nblocal = atom->nlocal;
  MPI_Allreduce(&nblocal, &atom->natoms, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (atom->natoms < 0 || atom->natoms >= MAXBIGINT)
    error->all(FLERR, Error::NOLASTLINE, "Too many total atoms");
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
  const std::string types = mesh_fields ? "type" + mesh_fields->types()
                                        : types_made(nlocal_previous);
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

/* ----------------------------------------------------------------------
   settings, lattice of sites
------------------------------------------------------------------------- */

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
    if (narg < 3) utils::missing_cmd_args(FLERR, "create_points region", error);
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

/* ----------------------------------------------------------------------
   the lattice of sites, and what all points have in common
------------------------------------------------------------------------- */

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
      error->all(FLERR, where, "Create_points fix {} is a fix {}, not a fix mpm", fix_id,
                 ifix->style);
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
                     spacing[d], axis_name[d], fix->id(), fix->lattice.h);
  }
  find_split(options);
  cut = cut || relax;
}

/* ----------------------------------------------------------------------
   keyword split: which sites are divided, by a variable of their position
------------------------------------------------------------------------- */

void CreatePoints::find_split(const Options &options)
{
  if (split.empty()) return;
  const int where = options.where("split") + 1;
  if (image)
    error->all(FLERR, where,
               "Create_points keyword split is for regions: use a finer spacing or sites pixels");
  auto *variable = input->variable;
  const auto find = [&](const std::string &word, int iarg, bool place) {
    const int index = utils::strmatch(word, "^v_") ? variable->find(word.c_str() + 2) : -1;
    if (index < 0)
      error->all(FLERR, iarg, "Create_points split {}: there is no such variable; expected v_name",
                 word);
    if (!(place ? variable->internalstyle(index) : variable->equalstyle(index)))
      error->all(FLERR, iarg, "Create_points split {}: variable must be of style {}", word,
                 place ? "internal" : "equal");
    return index;
  };
  split_variable = find(split, where, false);
  for (int d = 0; d < domain->dimension; d++)
    place_variable[d] = find(split_place[d], where + 1 + d, true);
}

/** Number of points along each axis into which the site is divided. */
int CreatePoints::divisions(const bigint *s) const
{
  for (int d = 0; d < domain->dimension; d++)
    input->variable->internal_set(place_variable[d], position(d, s[d]));
  const double n = input->variable->compute_equal(split_variable);
  if (n != std::floor(n) || n < 1.0 || n > MAX_PPC)
    error->one(FLERR, Error::NOLASTLINE,
               "Create_points split: variable {} is {:.8g} at {:.6g} {:.6g} {:.6g}, but must be an "
               "integer from 1 to {}",
               split.substr(2), n, position(0, s[0]), position(1, s[1]), position(2, s[2]),
               MAX_PPC);
  return (int) n;
}

/** Visits the center of each part of a divided site that is in the region, x fastest. Returns the
 *  number of all parts. */
int CreatePoints::for_parts(const bigint *s,
                            const std::function<void(const double *x)> &visit) const
{
  const int dim = domain->dimension, n = divisions(s);
  const int total = dim == 2 ? n * n : n * n * n;
  for (int part = 0; part < total; part++) {
    const int k[3] = {part % n, part / n % n, part / n / n};
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = position(d, s[d]) + (d < dim ? ((k[d] + 0.5) / n - 0.5) * spacing[d] : 0.0);
    if (!(fix && fix->options.axisymmetric && x[0] < 0.0) &&
        (!region || region->match(x[0], x[1], x[2])))
      visit(x);
  }
  return total;
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

/* ----------------------------------------------------------------------
   the fix mpm whose lattice is used when the input does not name one
------------------------------------------------------------------------- */

void CreatePoints::find_lattice()
{
  if (fix) return;
  for (auto *other : MPMField::all(lmp)) {
    if (!fix) fix = other;
    bool same = other->lattice.h == fix->lattice.h;
    for (int d = 0; d < domain->dimension; d++)
      same = same && other->lattice.origin[d] == fix->lattice.origin[d];
    if (!same)
      error->all(FLERR, Error::NOPOINTER,
                 "Fixes mpm {} and {} have different lattices: say with "
                 "create_points keyword fix which one is meant",
                 fix->id(), other->id());
  }
}

/* ----------------------------------------------------------------------
   sites in the box and sites that can be in the region
   the box is half open: a point on an upper face would belong to no rank
   on a periodic axis exactly one image of each site is in the range, also when rounding
   decides on which side of the box a site is (positions are wrapped later)
------------------------------------------------------------------------- */

void CreatePoints::find_ranges()
{
  std::array<double, 3> lo, hi;
  lo.fill(-10.0 * INFINITE);
  hi.fill(10.0 * INFINITE);
  if (region && region->bboxflag && !region->dynamic && !region->varshape) {
    lo = {region->extent_xlo, region->extent_ylo, region->extent_zlo};
    hi = {region->extent_xhi, region->extent_yhi, region->extent_zhi};
  }
  for (int d = 0; d < domain->dimension && image; d++) {
    // a site whose center is beyond a surface may still contain a part of the body
    const double more = image->surface ? 0.5 * spacing[d] : 0.0;
    lo[d] = std::max(lo[d], image->lo[d] - more);
    hi[d] = std::min(hi[d], image->hi(d) + more);
  }
  // only the half with x >= 0 of a body on the axis
  if (fix && fix->options.axisymmetric && lo[0] > -INFINITE) lo[0] = std::max(lo[0], 0.0);

  for (int d = 0; d < domain->dimension; d++) {
    const double boxlo = domain->boxlo[d], boxhi = domain->boxhi[d];
    // also cells whose center is outside the region
    const double beyond = cut || split_variable >= 0 ? 0.5 * spacing[d] : 0.0;
    const bool periodic = domain->periodicity[d];

    // site number, rounded up; a site within the tolerance below counts as being there

    auto first_from = [&](double x) {
      const double s = (x - origin[d]) / spacing[d] - 0.5;
      if (!(fabs(s) < MAX_INDEX))
        error->all(FLERR, Error::NOLASTLINE,
                   "Create_points spacing {:.8g} is too fine for this box or region", spacing[d]);
      return (bigint) ceil(s - TOLERANCE);
    };

    bigint first = first_from(boxlo), end = first_from(boxhi);
    if (periodic) {
      const double nsite = domain->prd[d] / spacing[d];
      if (fabs(nsite - round(nsite)) < TOLERANCE * 10.0) {
        end = first + (bigint) round(nsite);
      } else if (lo[d] < position(d, first) && hi[d] > position(d, end - 1) && comm->me == 0) {
        error->warning(FLERR,
                       "Create_points spacing {:.8g} does not divide the length {:.8g} of the box "
                       "along periodic axis {}: points across the boundary are not at this spacing",
                       spacing[d], domain->prd[d], axis_name[d]);
      }
    } else {
      while (position(d, first) < boxlo) first++;
      while (position(d, end) < boxhi) end++;
    }
    box[d] = {first, std::max(end - first, (bigint) 0)};

    if (lo[d] > -INFINITE) first = first_from(lo[d] - beyond);
    if (hi[d] < INFINITE) end = first_from(hi[d] + beyond + 2.0 * TOLERANCE * spacing[d]);
    search[d] = {first, std::max(end - first, (bigint) 0)};
  }
}

/* ---------------------------------------------------------------------- */

/** Share of the volume of a site that its point gets; 0: no point. */
double CreatePoints::share_of(const bigint *s) const
{
  if (region_cut) return region_cut->inside(s).share;
  if (split_variable >= 0) {
    int inside = 0;
    const int all = for_parts(s, [&](const double *) {
      inside++;
    });
    return (double) inside / all;
  }
  double x[3] = {position(0, s[0]), position(1, s[1]), position(2, s[2])};
  if (region && !region->match(x[0], x[1], x[2])) return 0.0;
  if (!image) return 1.0;
  return image->surface ? surface_share(s) : image->type_at(x) > 0;
}

/* ----------------------------------------------------------------------
   the point of a cell that the surface of the region may cut, if there is one
   where cells reach across the face of a box that is not periodic, the center may be beyond it
------------------------------------------------------------------------- */

bool CreatePoints::cut_site(const bigint *s, Site &site) const
{
  const auto part = region_cut->point(s, [this](const bigint *other) {
    return in_box(other) && search[0].contains(other[0]) && search[1].contains(other[1]) &&
        search[2].contains(other[2]);
  });
  if (part.share == 0.0) return false;
  site = {{part.x[0], part.x[1], part.x[2]}, part.share * volume, 0};
  for (int d = 0; d < domain->dimension; d++)
    if (!domain->periodicity[d] && !(site.x[d] >= domain->boxlo[d] && site.x[d] < domain->boxhi[d]))
      site.x[d] = position(d, s[d]);
  domain->remap(site.x);
  return true;
}

/* ----------------------------------------------------------------------
   visit the sites first to last-1 of a range, x fastest
------------------------------------------------------------------------- */

void CreatePoints::for_sites(const Range *range, bigint first, bigint last,
                             const std::function<void(const bigint *s)> &visit) const
{
  if (first >= last) return;
  bigint k[3] = {first % range[0].n, first / range[0].n % range[1].n,
                 first / range[0].n / range[1].n};
  for (bigint n = first; n < last; n++) {
    const bigint s[3] = {range[0].first + k[0], range[1].first + k[1], range[2].first + k[2]};
    visit(s);
    k[0]++;
    for (int d = 0; d < 2 && k[d] == range[d].n; d++) {
      k[d] = 0;
      k[d + 1]++;
    }
  }
}

/** Can sites be counted that may be in the region, also outside of the box? */
bool CreatePoints::is_countable() const
{
  return (double) search[0].n * search[1].n * search[2].n / comm->nprocs < MAX_COUNT;
}

/** Keyword cut: of a region much larger than the box, only the part in the box matters. */
void CreatePoints::begin_cut()
{
  bigint first[3], last[3];
  for (int d = 0; d < 3; d++) {
    const Range &range = is_countable() ? search[d] : box[d];
    first[d] = range.first - 1;
    last[d] = range.end();
  }
  region_cut = std::make_unique<MPMRegionCut>(lmp, region, origin, spacing,
                                              fix && fix->options.axisymmetric, first, last);
}

/* ----------------------------------------------------------------------
   refuse, or report, parts of the region outside the box
------------------------------------------------------------------------- */

void CreatePoints::check_outside()
{
  bool exceeds = false, empty = false;
  for (int d = 0; d < domain->dimension; d++) {
    exceeds = exceeds || search[d].first < box[d].first || search[d].end() > box[d].end();
    empty = empty || search[d].n == 0;
  }
  if (!exceeds || empty) return;

  const std::string what = image ? "image" : fmt::format("region {}", region->id);
  std::string count = "an unknown number of";
  if (is_countable()) {
    const bigint n = search[0].n * search[1].n * search[2].n;
    bigint mine = 0, all = 0;
    for_sites(search, n * comm->me / comm->nprocs, n * (comm->me + 1) / comm->nprocs,
              [&](const bigint *s) {
                mine += !in_box(s) && in_region(s);
              });
    MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (all == 0) return;
    count = std::to_string(all);
  }

  if (!ignore_outside)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points {} reaches beyond the simulation box: {} points would be "
               "outside; enlarge the box, cut the {}, or use create_points keyword outside "
               "ignore",
               what, count, image ? "image" : "region");
  if (comm->me == 0)
    utils::logmesg(lmp, "Create_points leaves out {} points of {} outside the box\n", count, what);
}

/* ----------------------------------------------------------------------
   refuse, or report, new points close to material points that exist refuse, or report, new points
   close to existing material points An existing point is closer than half a spacing along all axes
   to one site only, that of the cell of the site lattice that it is in: no other points need to be
   looked at. A body whose points have a share of the volume is meant to be in the same place as one
   in another field.
------------------------------------------------------------------------- */

/** Does atom i belong to the body of the new points? It does if it is in a field that they are in
 *  or, where they are in no field yet, if it has their type. */
bool CreatePoints::same_body(int i) const
{
  const int bits = group_bits | 1;    // 1: all
  bool in_field = false;
  for (const auto *field : MPMField::all(lmp)) {
    if (!(bits & field->fix.groupbit)) continue;
    in_field = true;
    if (atom->mask[i] & field->fix.groupbit) return true;
  }
  return !in_field && atom->type[i] == type;
}

void CreatePoints::check_overlap()
{
  const int dim = domain->dimension;
  double **x = atom->x;
  bigint mine[2] = {0, -MAXTAGINT}, all[2], apart = 0, all_apart;

  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    const bool same = same_body(i);
    if (share < 1.0 && !same) continue;
    bigint s[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) {
      s[d] = (bigint) floor((x[i][d] - origin[d]) / spacing[d]);
      if (domain->periodicity[d] && box[d].n > 0) {
        if (s[d] < box[d].first) s[d] += box[d].n;
        if (s[d] >= box[d].end()) s[d] -= box[d].n;
      }
    }
    // the rest of a cut cell may belong to another body
    if (!in_box(s) || !in_region(s)) continue;
    if ((cut || split_variable >= 0) && region && !region->match(x[i][0], x[i][1], x[i][2]))
      continue;
    mine[0]++;
    apart += !same;
    mine[1] = std::max(mine[1], -(bigint) atom->tag[i]);
  }
  MPI_Allreduce(&mine[0], &all[0], 1, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&mine[1], &all[1], 1, MPI_LMP_BIGINT, MPI_MAX, world);
  if (all[0] == 0) return;
  MPI_Allreduce(&apart, &all_apart, 1, MPI_LMP_BIGINT, MPI_SUM, world);

  const auto message = fmt::format("{} existing material point{} (the first has ID {}) closer than "
                                   "half a spacing to new points",
                                   all[0], all[0] > 1 ? "s are" : " is", -all[1]);
  if (!allow_overlap)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points refuses overlapping bodies: {}; change the "
               "region, delete the old points first, or use create_points keyword overlap yes{}",
               message,
               all_apart ? "; of a soil and the water in its pores make the soil first, and the "
                           "water with keyword share"
                         : "");
  if (comm->me == 0) error->warning(FLERR, "Create_points makes overlapping bodies: {}", message);
}

/* ----------------------------------------------------------------------
   position of the point of a site: the site's, displaced by jitter, inside the box. The random
   number comes from the site and the seed alone
------------------------------------------------------------------------- */

void CreatePoints::point_position(const bigint *s, double *x) const
{
  for (int d = 0; d < 3; d++) {
    x[d] = position(d, s[d]);
    if (jitter == 0.0 || d >= domain->dimension) continue;
    uint64_t h = mix_bits((uint64_t) seed * 4 + d + RANDOM_STEP);
    for (int k = 0; k < 3; k++) h = mix_bits((h ^ (uint64_t) s[k]) + RANDOM_STEP);
    const double u = (h >> 11) * 0x1.0p-53;
    const double move = (2.0 * u - 1.0) * jitter * spacing[d];
    for (double xnew : {x[d] + move, x[d] - move})
      if (domain->periodicity[d] || (xnew >= domain->boxlo[d] && xnew < domain->boxhi[d])) {
        x[d] = xnew;
        break;
      }
  }
  domain->remap(x);
}

/* ----------------------------------------------------------------------
   sites that are in the box and can be in the region; returns how many there are
------------------------------------------------------------------------- */

bigint CreatePoints::ranges_in_box(Range *range) const
{
  double nsite = 1.0;
  for (int d = 0; d < 3; d++) {
    const bigint first = std::max(search[d].first, box[d].first);
    const bigint end = std::min(search[d].end(), box[d].end());
    range[d] = {first, std::max(end - first, (bigint) 0)};
    nsite *= range[d].n;
  }
  if (nsite > MAX_SITES)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points would have to look at {:.3g} sites: use a "
               "wider spacing or a region with a bounding box",
               nsite);
  return range[0].n * range[1].n * range[2].n;
}

/* ----------------------------------------------------------------------
   look at all sites once, in the order of their numbers, and make the points
   IDs follow that order; returns the number of points
------------------------------------------------------------------------- */

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
      const double part = cut || split_variable >= 0 ? 0.0 : share_of(s);
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

/** Makes the points of a divided site. */
void CreatePoints::make_parts(const bigint *s, std::vector<Site> &made) const
{
  const std::size_t first = made.size();
  const int all = for_parts(s, [&](const double *x) {
    made.push_back({{x[0], x[1], x[2]}, 0.0, 0});
    for (int d = 0; d < domain->dimension; d++)
      if (!domain->periodicity[d] && !(x[d] >= domain->boxlo[d] && x[d] < domain->boxhi[d])) {
        made.pop_back();
        beyond_box++;
        return;
      }
    domain->remap(made.back().x);
  });
  for (auto k = first; k < made.size(); k++) made[k].volume = volume / all;
}

/* ---------------------------------------------------------------------- */

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

/* ----------------------------------------------------------------------
   send sites to their owners, where they arrive in the same order in each run
------------------------------------------------------------------------- */

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

/* ---------------------------------------------------------------------- */

int CreatePoints::owner(double *x) const
{
  int unused[3];
  return comm->nprocs == 1 ? 0 : comm->coord2proc(x, unused[0], unused[1], unused[2]);
}

/* ---------------------------------------------------------------------- */

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

/* ----------------------------------------------------------------------
   create_points TYPE mesh FILE keyword value ...: a point at each node of a mesh of finite elements
   create_points TYPE elements FILE keyword value ...: a point for each element of a mesh, which is
   its domain with shape cpdi2 of fix mpm
------------------------------------------------------------------------- */

Options CreatePointsMeshOptions::declare(const std::string &command, int dim, bool has_radius,
                                         bool nodes)
{
  using namespace option;
  Options o(command);
  o.add("scale",
        {number(scale, "factor", POSITIVE, "",
                "factor by which the coordinates in the file are multiplied")});
  o.add("move",
        {axes(move, dim, "x y z", ANY_NUMBER, "distance",
              "displacement that is added to the scaled coordinates")});
  o.add("part", {text(part, "name", "name or tag of a physical group of the mesh")})
      .standard("all elements of the dimension of the simulation");
  o.add("types", {word(by_type, {{"one", false}, {"physical", true}})},
        "types of the points: the same for all, or the tag or number of their physical group");
  o.add("groups", {word(by_group, {{"none", false}, {"physical", true}})},
        "additional groups that points join, with the names of their physical groups");
  o.add("data",
        {text(one.name, "name", "name of data in the file, for nodes (mesh) or elements"),
         text(one.quantity, "quantity",
              "quantity of the points that these data give, named like columns of a table; may be "
              "given several times")})
      .standard("none")
      .then([this] {
        data.push_back({one.name, one.quantity, 1.0});
      });
  o.add("factor",
        {text(one.name, "name", "name of data in the file"),
         number(one.factor, "a", ANY_NUMBER, "",
                "factor by which these data are multiplied, for other units; may be given for "
                "several data")})
      .standard("1")
      .then([this] {
        factors.push_back(one);
      });
  if (nodes) thin.declare(o, dim);
  o.add("halve",
        {integer(halve, "N", {0, 6, true},
                 "number of times that edges of elements are halved: 4^N (solids: 8^N) points in "
                 "each element")});
  o.add("diameter",
        {number(diameter, "D", POSITIVE, "distance",
                "diameter of the points in contact with grains")})
      .standard("edge of a cube (2d: square) of the volume");
  o.add("group",
        {text(group_id, "group-ID",
              "group that the points join; it is created if it does not exist")})
      .standard("all");
  o.refuse([this, has_radius, nodes] {
    auto rules = thin.rules();
    rules.push_back({nodes && halve > 0, "halve",
                     "is for points in elements: use create_points elements, or a finer mesh"});
    rules.push_back({!has_radius, "diameter", "needs atom_style hybrid sphere mpm"});
    return rules;
  });
  return o;
}

void CreatePoints::parse_mesh(int narg, char **arg)
{
  const std::string what = std::string("create_points ") + arg[1];
  if (narg < 3) utils::missing_cmd_args(FLERR, what, error);
  for (auto *field : MPMField::all(lmp))
    if (field->options.axisymmetric) fix = field;
  const bool in_elements = strcmp(arg[1], "elements") == 0;
  if (fix && !in_elements)
    error->all(FLERR, 1,
               "Create_points mesh cannot be used with axisymmetric fix mpm {}: elements, to "
               "which its points belong, are of plane strain; use create_points elements or region",
               fix->id());

  const int dim = domain->dimension;
  CreatePointsMeshOptions given;
  Options options = given.declare(what, dim, atom->radius_flag, !in_elements);
  read_options(lmp, options, narg, arg, 3);
  diameter = given.diameter;
  find_group(options, given.group_id);

  Mesh mesh = read_body(lmp, arg[2], given.part, given.thin.dimension(dim), "Create_points", 2);
  for (auto &x : mesh.nodes)
    for (int d = 0; d < 3; d++) x[d] = d < dim ? given.move[d] + given.scale * x[d] : 0.0;

  for (int k = 0; k < given.halve; k++) mesh.halve_elements();
  for (const auto &factor : given.factors) {
    bool used = false;
    for (auto &data : given.data)
      if (data.name == factor.name) {
        data.factor *= factor.factor;
        used = true;
      }
    if (!used)
      error->all(FLERR, options.where("factor") + 1,
                 "Create_points factor {}: no keyword data takes data of this name", factor.name);
  }
  mesh_fields = std::make_unique<MPMMeshFields>(lmp, mesh, !in_elements, type, given.by_type,
                                                given.by_group, given.data);
  volume = 0.0;
  if (in_elements)
    find_elements(mesh, arg[2]);
  else
    find_nodes(mesh, given.thin, arg[2]);
  volume /= mesh_sites.size();

  check_periodic(mesh, arg[2]);
  wrap_sites(arg[2], in_elements ? "elements" : "nodes");
  if (in_elements && MPMField::all(lmp).empty() && modify->get_fix_by_style("^mpm/mesh$").empty() &&
      comm->me == 0)
    error->warning(
        FLERR,
        "Create_points elements: only centers and volumes of the elements are used, for "
        "there is no fix mpm or mpm/mesh yet: with shape cpdi2, define the fix mpm before");
}

/* ----------------------------------------------------------------------
   a mesh that is longer than a periodic box would be wrapped onto itself
------------------------------------------------------------------------- */

void CreatePoints::check_periodic(const Mesh &mesh, const char *file) const
{
  for (int d = 0; d < domain->dimension; d++) {
    if (!domain->periodicity[d]) continue;
    const auto [first, last] = std::minmax_element(mesh.nodes.begin(), mesh.nodes.end(),
                                                   [d](const auto &a, const auto &b) {
                                                     return a[d] < b[d];
                                                   });
    const double length = (*last)[d] - (*first)[d];
    if (length > domain->prd[d] * (1.0 + TOLERANCE))
      error->all(
          FLERR, 2,
          "Create_points: mesh {} is {:.6g} long along {}, longer than the periodic box with "
          "{:.6g}, and would overlap itself; enlarge the box, or use the keyword scale",
          file, length, axis_name[d], domain->prd[d]);
  }
}

/* ----------------------------------------------------------------------
   move points into the box, which may be from one of the next periodic images: a point that is
   farther away is a mistake, and LAMMPS would move it image by image
------------------------------------------------------------------------- */

void CreatePoints::wrap_sites(const char *file, const char *what)
{
  bigint outside = 0;
  for (auto &site : mesh_sites) {
    bool inside = true;
    for (int d = 0; d < 3; d++) {
      const double reach = domain->periodicity[d] ? domain->prd[d] : 0.0;
      inside =
          inside && site.x[d] >= domain->boxlo[d] - reach && site.x[d] < domain->boxhi[d] + reach;
    }
    if (inside)
      domain->remap(site.x, site.image);
    else
      outside++;
  }
  if (outside)
    error->all(
        FLERR, 2,
        "Create_points: {} {} of {} are outside of the simulation box, along periodic axes by "
        "more than its length; enlarge the box, or use the keywords scale and move",
        outside, what, file);
}

/* ----------------------------------------------------------------------
   a node gets its share of the volume of the elements around it
------------------------------------------------------------------------- */

static constexpr char bad_element[] = "Create_points: element {} of {} has no volume or is twisted";

void CreatePoints::find_nodes(const Mesh &mesh, const MPMThinBody &thin, const char *file)
{
  for (const auto &x : mesh.nodes) mesh_sites.push_back({{x[0], x[1], x[2]}, 0.0, 0});
  for (const auto &e : mesh.elements) {
    const auto &rule = ElementRule::of(e.type);
    double x[MAX_ELEMENT_NODES][3], g[MAX_ELEMENT_NODES][3];
    for (int k = 0; k < rule.nnode; k++) MathExtra::copy3(mesh.nodes[e.node[k]].data(), x[k]);
    for (int q = 0; q < rule.npoint; q++) {
      const double w = thin ? thin.across() * rule.gradients_along(q, x, g)
                            : rule.gradients(q, x, g);
      if (!(w > 0.0)) error->all(FLERR, 2, bad_element, e.label, file);
      volume += w;
      for (int k = 0; k < rule.nnode; k++) mesh_sites[e.node[k]].volume += w * rule.N[q][k];
    }
  }
}

/* ----------------------------------------------------------------------
   an element is the domain of its point
------------------------------------------------------------------------- */

/** Nodes as corners of the domain, by ElementType. */
static constexpr int corner_nodes[][8] = {
    {0, 1, 2, 2}, {0, 1, 3, 2}, {0, 1, 2, 2, 3, 3, 3, 3}, {0, 1, 3, 2, 4, 5, 7, 6}};

void CreatePoints::find_elements(const Mesh &mesh, const char *file)
{
  const int dim = domain->dimension, ncorner = 1 << dim;
  for (const auto &e : mesh.elements) {
    Site site = {{0.0, 0.0, 0.0}, 0.0, 0};
    Corners corner;
    const int *node = corner_nodes[static_cast<int>(e.type)];
    double w[8], g[24];
    for (int c = 0; c < ncorner; c++)
      for (int d = 0; d < dim; d++) corner[dim * c + d] = mesh.nodes[e.node[node[c]]][d];
    site.volume = dim == 2 ? PointDomain<2>::free(corner.data(), w, g)
                           : PointDomain<3>::free(corner.data(), w, g);
    if (!(site.volume > 0.0 && *std::min_element(w, w + ncorner) >= 0.0))
      error->all(FLERR, 2, bad_element, e.label, file);
    for (int c = 0; c < ncorner && fix; c++)
      if (corner[dim * c] < -1.0e-10 * domain->xprd)
        error->all(FLERR, 2,
                   "Create_points: element {} of {} reaches below x = 0, which is the axis of "
                   "fix mpm {}",
                   e.label, file, fix->id());
    for (int d = 0; d < dim; d++) {
      for (int c = 0; c < ncorner; c++) site.x[d] += w[c] * corner[dim * c + d];
      for (int c = 0; c < ncorner; c++) corner[dim * c + d] -= site.x[d];
    }
    volume += site.volume;
    mesh_sites.push_back(site);
    corners.push_back(corner);
  }
}

/* ----------------------------------------------------------------------
   all ranks have all sites, and IDs follow their order in the file; returns the number of points
------------------------------------------------------------------------- */

bigint CreatePoints::make_mesh_points()
{
  const bigint n = mesh_sites.size();
  const tagint maxtag = largest_tag();
  check_tags(maxtag, n);
  if (comm->nprocs > 1) comm->coord2proc_setup();
  std::vector<Corners> mine;
  for (bigint k = 0; k < n; k++) {
    auto &site = mesh_sites[k];
    site.volume /= mesh_fields->jacobian((int) k);
    if (owner(site.x) != comm->me) continue;
    site.tag = atom->tag_enable ? maxtag + k + 1 : 0;
    mesh_fields->add((int) k);
    make_point(site);
    if (!corners.empty()) mine.push_back(corners[k]);
  }
  corners.swap(mine);
  return n;
}

/* ----------------------------------------------------------------------
   set the corners of the domains, once fixes have rows for the new points
------------------------------------------------------------------------- */

void CreatePoints::set_domains(int first)
{
  const int n = domain->dimension << domain->dimension;
  for (auto *field : MPMField::all(lmp)) {
    if (!field->domains || !field->domains->corners) continue;
    for (std::size_t k = 0; k < corners.size(); k++)
      std::copy_n(corners[k].data(), n, field->domains->corners[first + k]);
  }
}
