/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "create/create_points_image.h"

#include "create/create_points.h"

#include "atom.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "create/mpm_point_columns.h"
#include "domain.h"
#include "error.h"
#include "lammps.h"
#include "region.h"

#include "fmt/format.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double TOLERANCE = 1.0e-6;    // relative, of the length of an image and of the box
static constexpr double MAX_SMOOTH = 100.0;    // pixels
static constexpr double SLIVER = 0.1;          // share of a site that is too small for a point

void CreatePointsImageOptions::add_to(Options &o, int dim)
{
  using namespace option;
  o.add("pixel",
        {one_or_axes(pixel, dim, "p px py pz", POSITIVE, "distance",
                     "length of the edges of a pixel", "length of a pixel along x, y, z")})
      .standard("as the file says");
  o.add("origin",
        {option::axes(origin, dim, "x y z", ANY_NUMBER, "distance",
                      "lower corner of the image in the box")});
  std::vector<OptionValue> words = {
      text(axes[0], "C", "axis of the box along which columns are counted: x, y, z, -x, -y, or -z"),
      text(axes[1], "R", "the same for rows, from the first row in the file on")};
  if (dim == 3) words.push_back(text(axes[2], "S", "the same for slices, in 3d only"));
  o.add("axes", words).standard("x -y z for pictures and x y z for NRRD and raw");
  o.add("threshold",
        {number(threshold, "T", ANY_NUMBER, "",
                "pixels with at least this gray value belong to the body")})
      .standard("half of white");
  o.add("invert", {yes_no(invert)}, "pixels below the threshold belong to the body");
  o.add(
       "from",
       {number(from_value, "V", ANY_NUMBER, "",
               "gray value at and above which points have another type"),
        text(
            from_type, "type",
            "this other type, NULL for no points; may be given several times, in ascending order")})
      .then([this] {
        from.emplace_back(from_value, from_type);
      })
      .standard("none");
  o.add("color",
        {numbers(color, 3, "R G B", {0.0, 65535.0, true}, "", "color of pixels"),
         text(color_type, "type",
              "type of points in these pixels, NULL for no points; may be given several times")})
      .then([this] {
        colors.push_back({{color[0], color[1], color[2]}, color_type});
      })
      .standard("none");
  o.add("sites",
        {word(on_pixels,
              {{"lattice", false, "points at the sites of ppc or spacing"},
               {"pixels", true, "a point at the center of each pixel"}})});
  o.add("smooth",
        {number(
            smooth, "W", {0.0, MAX_SMOOTH, true}, "",
            "find the surface between pixels from values smoothed over W pixels; 0: no smoothing")})
      .standard("the surface is that of the pixels");
  o.add("field",
        {text(field.name, "name",
              "d_name of fix property/atom, or a history variable, which is set to a times the "
              "gray value plus b"),
         number(field.scale, "a", ANY_NUMBER, "", "factor"),
         number(field.offset, "b", ANY_NUMBER, "",
                "offset; may be given several times, for several names")})
      .then([this] {
        fields.push_back(field);
      })
      .standard("none");
  o.add("in", {text(region_id, "region-ID", "region to which the points are limited in addition")})
      .standard("all of the image");
  o.add("raw",
        {numbers(raw.n, 3, "NX NY NZ", POSITIVE, "",
                 "numbers of columns, rows, and slices of a file without a header"),
         word(raw.kind,
              {{"uint8", static_cast<int>(ImageKind::UINT8)},
               {"int8", static_cast<int>(ImageKind::INT8)},
               {"uint16", static_cast<int>(ImageKind::UINT16)},
               {"int16", static_cast<int>(ImageKind::INT16)},
               {"uint32", static_cast<int>(ImageKind::UINT32)},
               {"int32", static_cast<int>(ImageKind::INT32)},
               {"float", static_cast<int>(ImageKind::FLOAT)},
               {"double", static_cast<int>(ImageKind::DOUBLE),
                "type of the numbers in this file"}})})
      .standard("the file has a header");
  o.add("endian",
        {word(raw.big_endian,
              {{"little", false}, {"big", true, "order of the bytes of a number, with raw"}})});
  o.add("skip",
        {integer(raw.skip, "N", NOT_NEGATIVE, "number of bytes in front of the values, with raw")});
  o.add("slices",
        {integer(slices.first, "first", NOT_NEGATIVE,
                 "number of the first file of a stack, which replaces %d or %04d in the name"),
         integer(slices.last, "last", NOT_NEGATIVE, "number of the last file")})
      .standard("one file");
}

OptionRules CreatePointsImageOptions::rules() const
{
  const bool is_raw = raw.n[0] > 0;
  return {{!is_raw, "endian", "is for values without a header: give keyword raw, too"},
          {!is_raw, "skip", "is for values without a header: give keyword raw, too"},
          {slices.last < slices.first, "slices", "ends before it begins: {slices}"},
          {is_raw && slices.last > slices.first && raw.n[2] != 1, "slices",
           "needs NZ = 1 with raw, as each file is one slice"},
          {!from.empty(), "invert",
           "is for a single threshold: give types to dark values with threshold and from"},
          {!colors.empty(), "invert", "is for gray values: give types to colors instead"},
          {!from.empty() || !colors.empty(), "smooth",
           "makes the surface of one body: use threshold alone, once for each body"}};
}

Options CreatePointsImageOptions::declare(int dim)
{
  Options o("create_points image");
  add_to(o, dim);
  o.refuse([this] {
    return rules();
  });
  return o;
}

/** Maps the words of keyword axes to the axes of the box and their directions. */
static void set_axes(LAMMPS *lmp, const CreatePointsImageOptions &given, const Options &options,
                     ImageBody &body)
{
  const std::string pictures[3] = {"x", "-y", "z"}, volumes[3] = {"x", "y", "z"};
  bool used[3] = {false, false, false};
  for (int c = 0; c < body.dim; c++) {
    const std::string word = options.given("axes") ? given.axes[c]
        : body.image.picture                       ? pictures[c]
                                                   : volumes[c];
    const bool minus = word[0] == '-';
    const std::string letter = word.substr(minus || word[0] == '+');
    const int d = letter == "x" ? 0 : letter == "y" ? 1 : letter == "z" ? 2 : 3;
    if (d >= body.dim || used[d])
      lmp->error->all(FLERR, options.where("axes") + 1 + c,
                      "Create_points axes {}: expected {}, each axis once, with - where the image "
                      "counts from its upper end",
                      word, body.dim == 2 ? "x and y" : "x, y, and z");
    used[d] = true;
    body.image_axis[d] = c;
    body.against[d] = minus;
  }
}

/** Sets which pixels are of which type. */
static void set_types(LAMMPS *lmp, const CreatePointsImageOptions &given, const Options &options,
                      int type, ImageBody &body)
{
  const auto expand = [&](const std::string &word, const char *keyword) {
    if (word == "NULL") return 0;
    const int one = utils::expand_type_int(FLERR, word, Atom::ATOM, lmp);
    if (one < 1 || one > lmp->atom->ntypes)
      lmp->error->all(FLERR, options.where(keyword),
                      "Invalid atom type {} after {} in create_points command, the box has {}",
                      word, keyword, lmp->atom->ntypes);
    return one;
  };
  for (const auto &[color, word] : given.colors)
    body.colors.push_back({{color[0], color[1], color[2]}, expand(word, "color")});
  if (!body.colors.empty() && body.image.channels != 3)
    lmp->error->all(FLERR, options.where("color"),
                    "Create_points color is for images with colors, but this one has gray values: "
                    "use threshold and from");

  body.below = given.invert;
  if (options.given("threshold") || body.colors.empty()) {
    if (!options.given("threshold") && body.image.largest == 0.0)
      lmp->error->all(FLERR, Error::NOPOINTER,
                      "Create_points image needs keyword threshold, as numbers of this kind have "
                      "no largest value that is white");
    body.steps.push_back(
        {options.given("threshold") ? given.threshold : 0.5 * body.image.largest, type});
  }
  for (const auto &[value, word] : given.from) {
    if (!body.steps.empty() && value <= body.steps.back().from)
      lmp->error->all(FLERR, options.where("from"),
                      "Create_points from {:.8g}: must be above the threshold and the gray value "
                      "before it, {:.8g}: give them in ascending order",
                      value, body.steps.back().from);
    body.steps.push_back({value, expand(word, "from")});
  }
}

/** Says what is wrong when no pixel belongs to a body; otherwise empty. */
static std::string without_body(const ImageBody &body)
{
  const auto &n = body.image.n;
  const int64_t all = n[0] * n[1] * n[2];
  double least = body.image.gray(0), most = least;
  for (int64_t k = 0; k < all; k++) {
    if (body.type_of(k)) return "";
    least = std::min(least, body.image.gray(k));
    most = std::max(most, body.image.gray(k));
  }
  if (body.steps.empty()) return "no pixel has one of the colors of the keyword color";
  return fmt::format(
      "no pixel is of a body: gray values are {:.8g} to {:.8g}, and the body has {} {:.8g}: "
      "use another threshold{}",
      least, most, body.below ? "less than" : "at least", body.steps.front().from,
      body.below ? "" : ", or invert");
}

/** Sets the size and the position of the pixels. */
static void place(LAMMPS *lmp, const CreatePointsImageOptions &given, const Options &options,
                  ImageBody &body, const char *file)
{
  auto *domain = lmp->domain;
  body.dim = domain->dimension;
  if (body.dim == 2 && body.image.n[2] != 1)
    lmp->error->all(FLERR, 2,
                    "Create_points image {} has {} slices, but the simulation is 2d: save one of "
                    "them as a file of its own, or use dimension 3",
                    file, body.image.n[2]);
  set_axes(lmp, given, options, body);
  for (int d = 0; d < body.dim; d++) {
    body.lo[d] = given.origin[d];
    body.pixel[d] = options.given("pixel") ? given.pixel[d]
                                           : body.image.spacing[body.image_axis[d]];
    if (!(body.pixel[d] > 0.0))
      lmp->error->all(
          FLERR, 2,
          "Create_points image {} does not say how long pixels are along {}: use keyword "
          "pixel",
          file, "xyz"[d]);
    const double length = body.hi(d) - body.lo[d];
    if (!std::isfinite(length) || body.lo[d] + body.pixel[d] == body.lo[d])
      lmp->error->all(FLERR, 2,
                      "Create_points image {}: pixels of {:.8g} along {} cannot be told apart",
                      file, body.pixel[d], "xyz"[d]);
    if (domain->periodicity[d] && length > domain->prd[d] * (1.0 + TOLERANCE))
      lmp->error->all(
          FLERR, 2,
          "Create_points image {} is {:.8g} long along {}, longer than the periodic box with "
          "{:.8g}, and would overlap itself; enlarge the box, or make pixels smaller",
          file, length, "xyz"[d], domain -> prd[d]);
  }
}

std::unique_ptr<ImageBody> LAMMPS_NS::read_image_body(LAMMPS *lmp,
                                                      const CreatePointsImageOptions &given,
                                                      const Options &options, int type,
                                                      const char *file)
{
  auto body = std::make_unique<ImageBody>();
  auto *error = lmp->error;
  std::string message;
  const bool mine = lmp->comm->me == 0;
  if (mine) {
    try {
      body->image = read_image(file, given.raw, given.slices);
    } catch (const std::bad_alloc &) {
      message = fmt::format("image {}: does not fit into the memory", file);
    } catch (const std::runtime_error &e) {
      message = e.what();
    }
  }
  broadcast(message, lmp->world);
  if (!message.empty()) error->all(FLERR, 2, "Create_points {}", message);

  ImageLayout &layout = body->image;
  MPI_Bcast(&layout, sizeof(ImageLayout), MPI_BYTE, 0, lmp->world);
  if (mine)
    utils::logmesg(lmp, "Read image {}: {} columns, {} rows, {} slice{}{}\n", file, layout.n[0],
                   layout.n[1], layout.n[2], layout.n[2] > 1 ? "s" : "",
                   layout.channels == 3 ? " in color" : "");
  if (mine && layout.turned && !options.given("axes"))
    error->warning(
        FLERR,
        "Create_points image {}: the file says that its columns, rows, and slices do not "
        "go along x, y, z; they do here: use the keyword axes, or displace_atoms rotate",
        file);
  place(lmp, given, options, *body, file);
  set_types(lmp, given, options, type, *body);
  if (mine) message = without_body(*body);
  broadcast(message, lmp->world);
  if (!message.empty())
    error->all(FLERR, Error::NOPOINTER, "Create_points image {}: {}", file, message);

  const bool smooth = options.given("smooth");
  if (mine && !smooth) body->crop();
  MPI_Bcast(&layout, sizeof(ImageLayout), MPI_BYTE, 0, lmp->world);
  MPI_Bcast(body->lo, 3, MPI_DOUBLE, 0, lmp->world);
  broadcast(body->image.data, lmp->world);

  if (smooth) {
    bool wraps[3];
    for (int d = 0; d < 3; d++)
      wraps[d] = d < body->dim && lmp->domain->periodicity[d] &&
          std::fabs(body->hi(d) - body->lo[d] - lmp->domain->prd[d]) <
              TOLERANCE * lmp->domain->prd[d];
    body->make_surface(given.smooth, wraps);
  }
  return body;
}

void CreatePoints::parse_image(int narg, char **arg)
{
  require_arguments(lmp, "create_points image", narg, 2, {"file"});
  const int dim = domain->dimension;
  CreatePointsImageOptions given;
  Options options("create_points image");
  add_to(options, dim);
  given.add_to(options, dim);
  options.refuse([&] {
    OptionRules all = rules(atom->radius_flag);
    for (const auto &rule : given.rules()) all.push_back(rule);
    for (const char *word : {"ppc", "spacing"})
      all.push_back({given.on_pixels, word,
                     "is not for points at the centers of pixels: leave out sites pixels"});
    return all;
  });
  read_options(lmp, options, narg, arg, 3);

  if (!given.region_id.empty()) {
    const int where = options.where("in") + 1;
    region = domain->get_region_by_id(given.region_id);
    if (!region)
      error->all(FLERR, where, "Create_points region {} does not exist", given.region_id);
    region->init();
    region->prematch();
  }
  for (const auto &field : given.fields) {
    if (!field_columns) field_columns = std::make_unique<MPMPointColumns>(lmp);
    const auto kind = field_columns->add(field.name);
    const bool real = kind == MPMPointColumns::PROPERTY && field.name[0] == 'd';
    if (!real && kind != MPMPointColumns::HISTORY)
      error->all(FLERR, options.where("field") + 1,
                 "Create_points field {} must be a vector of reals of fix property/atom, d_NAME, "
                 "or a history "
                 "variable of a fix mpm/material, which is defined before",
                 field.name);
    fields.push_back({field.scale, field.offset});
  }
  image = read_image_body(lmp, given, options, type, arg[2]);
  sites_on_pixels = given.on_pixels;
  place_sites(options);
}

/** Share of a site that is in the body of a surface. A site with only a sliver of the body gives
 *  it to the neighbor along an axis that has the most of the body, so that no volume is lost. */
/** Visits the neighbors of a site along the axes. */
template <class F> static void for_neighbors(const bigint *s, int dim, F &&visit)
{
  for (int d = 0; d < dim; d++)
    for (const int step : {-1, 1}) {
      bigint other[3] = {s[0], s[1], s[2]};
      other[d] += step;
      visit(other);
    }
}

double CreatePoints::surface_share(const bigint *s) const
{
  const int dim = domain->dimension;
  const auto own = [&](const bigint *k) {
    const double x[3] = {position(0, k[0]), position(1, k[1]), position(2, k[2])};
    return image->share_at(x, spacing);
  };
  double share = own(s);
  if (share < SLIVER) return 0.0;
  for_neighbors(s, dim, [&](const bigint *n) {
    const double sliver = own(n);
    if (!(sliver > 0.0 && sliver < SLIVER)) return;
    bigint taker[3] = {0, 0, 0};
    double most = 0.0;
    for_neighbors(n, dim, [&](const bigint *k) {
      const double there = own(k);
      if (there <= most) return;
      most = there;
      std::copy_n(k, 3, taker);
    });
    if (std::equal(taker, taker + 3, s)) share += sliver;
  });
  return share;
}

/** Type and gray value of the point of a site. */
void CreatePoints::look_at_image(const bigint *s, Site &site) const
{
  const double x[3] = {position(0, s[0]), position(1, s[1]), position(2, s[2])};
  if (!image->surface) site.type = image->type_at(x);
  if (!fields.empty()) site.gray = image->image.gray(image->nearest_pixel(x));
}

/** "type 1", or "types 1 (20), 2 (30)" when the new points are of several. */
std::string CreatePoints::types_made(int first) const
{
  std::vector<bigint> mine(atom->ntypes + 1, 0), all(mine);
  for (int i = first; i < atom->nlocal; i++) mine[atom->type[i]]++;
  MPI_Reduce(mine.data(), all.data(), (int) all.size(), MPI_LMP_BIGINT, MPI_SUM, 0, world);
  std::string text;
  int n = 0, last = 0;
  for (int t = 1; t <= atom->ntypes; t++) {
    if (all[t] == 0) continue;
    text += fmt::format("{}{} ({})", n++ ? ", " : "", t, all[t]);
    last = t;
  }
  return n > 1 ? "types " + text : "type " + std::to_string(last);
}

/** Gray values to properties and history, once fixes have rows for the new points. */
void CreatePoints::set_fields(int first)
{
  if (!field_columns) return;
  std::vector<double> rows;
  for (const double gray : grays)
    for (const auto &field : fields) rows.push_back(field.scale * gray + field.offset);
  field_columns->set(first, rows);
}
