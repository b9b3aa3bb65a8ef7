/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "create/create_points_table.h"

#include "create/create_points.h"

#include "atom.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "label_map.h"
#include "math/matrix.h"
#include "table/table.h"
#include "update.h"

#include "fmt/format.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <unordered_set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** The type with a label, or -1. The function of LAMMPS for it had another name until 2025. */
template <class Map>
static auto type_of_label(const Map &map, const std::string &label, int)
    -> decltype(map.find_type(label, Atom::ATOM))
{
  return map.find_type(label, Atom::ATOM);
}
template <class Map>
static auto type_of_label(const Map &map, const std::string &label, long)
    -> decltype(map.find(label, Atom::ATOM))
{
  return map.find(label, Atom::ATOM);
}

using Columns = MPMPointColumns;

static constexpr int CHUNK = 1 << 14;     // rows that are sent at a time
static constexpr double NEAR = 1.0e-4;    // in edges of a point; closer points are duplicates

Options CreatePointsTableOptions::declare(int dim, bool has_radius)
{
  using namespace option;
  Options o("create_points table");
  o.add("columns",
        {text(columns, "name,name,...",
              "names of the columns, separated by commas, for files without names")})
      .standard("as the file says");
  o.add("scale",
        {number(scale, "factor", POSITIVE, "",
                "factor by which lengths are multiplied, in positions and volumes")});
  o.add("move",
        {axes(move, dim, "x y z", ANY_NUMBER, "distance",
              "displacement that is added to the scaled positions")});
  o.add("factor",
        {text(factor.column, "name", "column of the file"),
         number(factor.value, "a", ANY_NUMBER, "",
                "factor by which this column is multiplied, for other units; may be given for "
                "several columns")})
      .standard("1")
      .then([this] {
        factors.push_back(factor);
      });
  o.add("data",
        {text(renamed[0], "name", "column of the file"),
         text(renamed[1], "quantity",
              "quantity in this column, or NULL to ignore the column; may be given for several "
              "columns")})
      .standard("the names of the columns")
      .then([this] {
        data.push_back(renamed);
      });
  o.add("volume",
        {number(volume, "V", POSITIVE, "volume",
                "initial volume of each point, for files without volumes")})
      .standard("a column");
  o.add("part", {integer(part, "T", POSITIVE, "type in the file of the rows to use")})
      .standard("all rows");
  o.add("ids", {word(new_ids, {{"file", false}, {"new", true}})},
        "IDs of the points: from the column id, if there is one, or new IDs");
  o.add("diameter",
        {number(diameter, "D", POSITIVE, "distance",
                "diameter of the points in contact with grains")})
      .standard("a column, or the edge of a cube (2d: square) of the volume");
  o.add("group",
        {text(group_id, "group-ID",
              "group that the points join; it is created if it does not exist")})
      .standard("all");
  o.refuse([has_radius] {
    return OptionRules{{!has_radius, "diameter", "needs atom_style hybrid sphere mpm"}};
  });
  return o;
}

CreatePointsTable::CreatePointsTable(LAMMPS *lmp, const CreatePointsTableOptions &given, int type,
                                     const char *file) :
    Pointers(lmp),
    columns(lmp)
{
  std::string message;
  if (comm->me == 0) {
    try {
      read(given, type, file);
    } catch (const std::bad_alloc &) {
      message = fmt::format("{}: does not fit into the memory", file);
    } catch (const std::runtime_error &e) {
      message = e.what();
    }
  }
  broadcast(message, world);
  if (!message.empty()) error->all(FLERR, 2, "Create_points table {}", message);

  // the other ranks need the names

  npoint = (bigint) points.size();
  MPI_Bcast(&npoint, 1, MPI_LMP_BIGINT, 0, world);
  std::string names = columns.names();
  broadcast(names, world);
  if (comm->me)
    for (const auto &name : utils::split_words(names)) columns.add(name == "NULL" ? "" : name);
  ncolumn = columns.size();
}

void CreatePointsTable::rows(bigint first, int n, std::vector<CreatePointsSite> &some,
                             std::vector<double> &numbers) const
{
  some.clear();
  numbers.clear();
  if (comm->me == 0) {
    some.assign(points.begin() + first, points.begin() + first + n);
    numbers.assign(values.begin() + first * ncolumn, values.begin() + (first + n) * ncolumn);
  }
  broadcast(some, world);
  broadcast(numbers, world);
}

/** Reads on rank 0, where errors are thrown as std::runtime_error. */
void CreatePointsTable::read(const CreatePointsTableOptions &given, int type,
                             const std::string &file)
{
  Table table = read_table(file, given.columns);
  const auto fail = [&](const std::string &what) {
    throw std::runtime_error(file + ": " + what);
  };
  if (!table.units.empty() && table.units != update->unit_style)
    fail("has units " + table.units + ", but this simulation has units " + update->unit_style);

  ncolumn = (int) table.names.size();
  const auto column = [&](const std::string &name, const char *keyword) {
    const auto at = std::find(table.names.begin(), table.names.end(), name);
    if (at == table.names.end())
      fail(fmt::format("has no column {}, which keyword {} has; there are {}", name, keyword,
                       utils::join_words(table.names, " ")));
    return at - table.names.begin();
  };
  for (const auto &factor : given.factors) {
    const auto c = column(factor.column, "factor");
    for (std::size_t row = 0; row < table.rows(); row++)
      table.values[row * ncolumn + c] *= factor.value;
  }
  std::vector<std::string> names = table.names;
  for (const auto &[name, quantity] : given.data)
    names[column(name, "data")] = quantity == "NULL" ? "" : quantity;

  for (int c = 0; c < ncolumn; c++) {
    const auto kind = columns.add(names[c]);
    if (kind == Columns::UNKNOWN)
      fail(fmt::format("column {} is nothing that points have: define the fix mpm/material or the "
                       "fix property/atom that has it "
                       "before, or say by data {} what it is, or NULL to leave it out",
                       names[c], table.names[c]));
    const int other = columns.same(c);
    if (other >= 0)
      fail(fmt::format("columns {} and {} are the same quantity: leave one out by data {} NULL",
                       table.names[other], table.names[c], table.names[c]));
  }
  make_points(given, table, type, file);
  check_points(file);

  utils::logmesg(lmp, "Read table {}: {} points\n  columns:{}\n", file, points.size(),
                 columns.names(true));
  const std::string left = columns.names(false);
  if (!left.empty()) utils::logmesg(lmp, "  not taken, as they follow from others:{}\n", left);
  if (table.is_dump)
    utils::logmesg(
        lmp, "  of step {} at time {:.15g}: go on there with reset_timestep {} time {:.15g}\n",
        table.step, table.time, table.step, table.time);
}

/** Positions, volumes, types, and IDs of all rows; keeps the rows of the part that is wanted. */
void CreatePointsTable::make_points(const CreatePointsTableOptions &given, const Table &table,
                                    int type, const std::string &file)
{
  const auto fail = [&](const std::string &what) {
    throw std::runtime_error(file + ": " + what);
  };
  const int dim = domain->dimension;
  int place[3];
  for (int d = 0; d < 3; d++) {
    place[d] = columns.find(Columns::PLACE, d);
    if (place[d] < 0 && d < dim) fail(fmt::format("has no column {}", "xyz"[d]));
  }
  const int type_column = columns.find(Columns::TYPE);
  if (given.part && type_column < 0) fail("has no column type, which keyword part needs");
  if (given.new_ids) columns.leave(Columns::ID);
  const int id_column = columns.find(Columns::ID);

  // columns that give the initial volume

  const int volume0 = columns.find(Columns::VOLUME0), volume = columns.find(Columns::VOLUME),
            mass = columns.find(Columns::MASS), density = columns.find(Columns::DENSITY);
  const bool has_volume = volume0 >= 0 || volume >= 0 || (mass >= 0 && density >= 0);
  if (has_volume && given.volume > 0.0)
    fail("has volumes of its own: leave the keyword volume out, or leave them out by data");
  if (!has_volume && !(given.volume > 0.0))
    fail(
        "has no volumes: it needs a column volume0, or volume, or mass and density, or the keyword "
        "volume");
  if (volume0 >= 0) columns.leave(Columns::VOLUME);
  if (volume0 >= 0 || volume >= 0 || mass < 0) columns.leave(Columns::DENSITY);
  int F[9], nF = 0;
  for (int k = 0; k < 9; k++) nF += (F[k] = columns.find(Columns::DEFORMATION, k)) >= 0;
  if (nF > 0 && nF < 9) fail(fmt::format("has {} columns of F, which has 9", nF));
  int ns = 0;
  for (int k = 0; k < 6; k++) ns += columns.find(Columns::STRESS, k) >= 0;
  if (ns > 0 && ns < 6)
    fail(fmt::format("has {} columns of stress, which has 6: xx yy zz xy xz yz", ns));

  for (std::size_t row = 0; row < table.rows(); row++) {
    const auto at = [&](int c) {
      return table.at(row, c);
    };
    int mine = type;
    if (type_column >= 0) {
      const double value = at(type_column);
      const std::string word = value < 0.0 && -1.0 - value < table.words.size()
          ? table.words[(int) (-1.0 - value)]
          : fmt::format("{}", value);
      if (value >= 0.0)
        mine = value <= atom->ntypes ? (int) value : 0;
      else
        mine = atom->labelmapflag ? type_of_label(*atom->lmap, word, 0) : 0;
      if (given.part && mine != given.part) continue;
      if (mine < 1 || mine > atom->ntypes || (value >= 0.0 && value != mine))
        fail(fmt::format("row {} has type {}, but types are 1 to {}{}", row + 1, word, atom->ntypes,
                         value < 0.0 ? ", or labels of labelmap" : ""));
    }
    for (int c = 0; c < ncolumn; c++) {
      const std::string wrong = columns.wrong(c, at(c));
      if (!wrong.empty())
        fail(
            fmt::format("row {} has {} = {:.8g}, which {}", row + 1, table.names[c], at(c), wrong));
    }
    CreatePointsSite point = {
        {0.0, 0.0, 0.0}, given.volume, id_column < 0 ? 0 : (tagint) at(id_column), mine};
    for (int d = 0; d < dim; d++) point.x[d] = given.move[d] + given.scale * at(place[d]);
    double J = 1.0;
    if (nF) {
      double matrix[9];
      for (int k = 0; k < 9; k++) matrix[k] = at(F[k]);
      J = determinant(matrix);
      if (!(J > 0.0))
        fail(fmt::format("row {} has F with a determinant of {:.8g}, which must be positive",
                         row + 1, J));
    }
    if (has_volume)
      point.volume = std::pow(given.scale, dim) *
          (volume0 >= 0      ? at(volume0)
               : volume >= 0 ? at(volume) / J
                             : at(mass) / at(density) / J);
    if (!std::isnormal(point.volume))
      fail(fmt::format("row {} has a volume of {}", row + 1, point.volume));
    points.push_back(point);
    values.insert(values.end(), table.values.begin() + row * ncolumn,
                  table.values.begin() + (row + 1) * ncolumn);
  }
  if (points.empty()) fail(fmt::format("has no points of type {}", given.part));
}

/** Warns of points that are the same except for round-off: they come from two files, or were
 *  written twice with different digits. Positions are sorted into cells of NEAR edges of a point,
 *  twice, with cells shifted by half of their width, so that hardly any pair is missed. */
void CreatePointsTable::warn_of_near_points(const std::string &file) const
{
  double volume = 0.0;
  for (const auto &point : points) volume += point.volume / points.size();
  const double cell = NEAR * std::pow(volume, 1.0 / domain->dimension);
  std::set<std::size_t> near;
  for (const double shift : {0.0, 0.5}) {
    using Place = std::array<double, 3>;
    std::vector<std::pair<Place, std::size_t>> places(points.size());
    for (std::size_t k = 0; k < points.size(); k++) {
      for (int d = 0; d < 3; d++)
        places[k].first[d] = std::floor((points[k].x[d] - domain->boxlo[d]) / cell + shift);
      places[k].second = k;
    }
    std::sort(places.begin(), places.end());
    for (std::size_t k = 1; k < places.size(); k++)
      if (places[k].first == places[k - 1].first) near.insert(places[k].second);
  }
  if (near.empty()) return;
  const double *const x = points[*near.begin()].x;
  error->warning(FLERR,
                 "Create_points table {}: {} points are within {:.3g} edges of others, as one at "
                 "{:.8g} {:.8g} "
                 "{:.8g}: if they are the same points twice, remove them from the file",
                 file, near.size(), NEAR, x[0], x[1], x[2]);
}

/** Moves points into the box from the next periodic images; refuses IDs and positions that occur
 *  twice. */
void CreatePointsTable::check_points(const std::string &file)
{
  const auto fail = [&](const std::string &what) {
    throw std::runtime_error(file + ": " + what);
  };
  bigint outside = 0;
  for (auto &point : points) outside += !point.wrap(domain);
  if (outside)
    fail(fmt::format(
        "{} of {} points are outside of the simulation box, along periodic axes by more than its "
        "length; enlarge the box, or use the keywords scale and move",
        outside, points.size()));

  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(points[a].x, points[a].x + 3, points[b].x, points[b].x + 3);
  };
  std::sort(order.begin(), order.end(), before);
  for (std::size_t k = 1; k < order.size(); k++)
    if (!before(order[k - 1], order[k]))
      fail(fmt::format(
          "two points are at the same place, {:.8g} {:.8g} {:.8g}: it has points twice, or "
          "frames of several times",
          points[order[k]].x[0], points[order[k]].x[1], points[order[k]].x[2]));
  warn_of_near_points(file);

  if (points[0].tag == 0) return;
  std::vector<tagint> tags;
  for (const auto &point : points) tags.push_back(point.tag);
  std::sort(tags.begin(), tags.end());
  const auto twice = std::adjacent_find(tags.begin(), tags.end());
  if (twice != tags.end())
    fail(fmt::format("two points have the ID {}: use the keyword ids new", *twice));
}

void CreatePoints::parse_table(int narg, char **arg)
{
  require_arguments(lmp, "create_points table", narg, 2, {"file"});
  CreatePointsTableOptions given;
  Options options = given.declare(domain->dimension, atom->radius_flag);
  read_options(lmp, options, narg, arg, 3);
  diameter = given.diameter;
  find_group(options, given.group_id);
  table = std::make_unique<CreatePointsTable>(lmp, given, type, arg[2]);
}

/** Rank 0 sends the rows in chunks to all ranks, each of which makes the points in its part of the
 *  box. */
bigint CreatePoints::make_table_points()
{
  const bigint n = table->npoint;
  const tagint maxtag = largest_tag();
  if (comm->nprocs > 1) comm->coord2proc_setup();
  const std::unordered_set<tagint> taken(atom->tag, atom->tag + atom->nlocal);
  bigint same = 0, all_same;
  std::vector<CreatePointsSite> some;
  std::vector<double> numbers;
  for (bigint first = 0; first < n; first += CHUNK) {
    const int count = (int) std::min((bigint) CHUNK, n - first);
    table->rows(first, count, some, numbers);
    if (first == 0 && some[0].tag == 0) check_tags(maxtag, n);
    for (int k = 0; k < count; k++) {
      Site site = some[k];
      if (!atom->tag_enable)
        site.tag = 0;
      else if (site.tag == 0)
        site.tag = (tagint) (maxtag + first + k + 1);
      same += taken.count(site.tag);
      if (owner(site.x) != comm->me) continue;
      make_point(site);
      table_rows.insert(table_rows.end(), numbers.begin() + (bigint) k * table->width(),
                        numbers.begin() + (bigint) (k + 1) * table->width());
    }
  }
  MPI_Allreduce(&same, &all_same, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all_same && atom->tag_enable)
    error->all(
        FLERR, 2,
        "Create_points table: {} points have IDs that atoms have already: use the keyword ids new",
        all_same);
  return n;
}

/** Sets the state of the points, once fixes have rows for them. */
void CreatePoints::set_columns(int first)
{
  if (table) table->columns.set(first, table_rows);
  if (mesh) mesh->fields->set(first);
  const MPMPointColumns *columns = table ? &table->columns
      : mesh                             ? &mesh->fields->given()
                                         : nullptr;
  const std::string missing = columns && columns->has_state() ? columns->missing() : "";
  if (!missing.empty() && comm->me == 0)
    error->warning(FLERR,
                   "Create_points {}: the points have state, but not all of it: that of new "
                   "points is {}; a "
                   "restart file has all",
                   table ? "table" : "data", missing);
}
