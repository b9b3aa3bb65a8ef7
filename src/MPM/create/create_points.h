/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMMAND_CLASS
// clang-format off
CommandStyle(create_points,CreatePoints);
// clang-format on
#else

#ifndef LMP_CREATE_POINTS_H
#define LMP_CREATE_POINTS_H

#include "command.h"
#include "create/create_points_mesh.h"
#include "declare/option.h"

#include <array>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace MPM_NS {
struct ImageBody;
class RelaxedPoints;
}    // namespace MPM_NS

namespace LAMMPS_NS {

struct CreatePointsOptions {
  static constexpr int MAX_PPC = 1000;

  int ppc[3] = {0, 0, 0};    ///< points per cell along each axis; 0: not given, 2
  double spacing[3] = {0.0, 0.0, 0.0};
  std::string fix_id;
  double jitter = 0.0;
  int seed = 0;
  bool allow_overlap = false, ignore_outside = false;
  double diameter = 0.0;    ///< for contact with grains; 0: edge length of the volume of the point
  double share = 1.0;       ///< share of the volume of its site that a point gets
  bool cut = false;         ///< points get the part of their cell that is in the region
  int relax = 0;            ///< number of times that points move to the centers of their cells
  /** split: equal-style variable with the number of points along each axis of a site; empty: one.
   *  split_place: internal-style variables that are set to the position of the site for it. */
  std::string split, split_place[3];
  std::string group_id;    ///< group that the points join; empty: none

  void add_to(MPM_NS::Options &, int dimension);
  /** Checks of their values. has_radius: points have a radius (atom_style hybrid sphere mpm). */
  MPM_NS::OptionRules rules(bool has_radius) const;
  MPM_NS::Options declare(int dimension, bool has_radius);
};

/** Command create_points: fills a region or the bodies of an image with material points on a
 *  regular lattice of sites, or makes a point at each node or for each element of a mesh, or at
 *  each row of a table.
 *
 *  Sites are at origin + (s + 1/2) spacing for integer s. Their numbering, the test against the
 *  region, the jitter, and the IDs are functions of the site alone. Ranks take equal shares of the
 *  sites of a bounding box in turn and send the points to their owners. So every site is visited
 *  exactly once, and the points do not depend on the number of ranks or the layout.
 */
class CreatePoints : public Command, private CreatePointsOptions {
 public:
  explicit CreatePoints(class LAMMPS *);
  ~CreatePoints() override;
  void command(int, char **) override;

 private:
  using Site = CreatePointsSite;
  struct Range {    // consecutive sites along an axis
    bigint first = 0, n = 1;
    bigint end() const { return first + n; }
    bool contains(bigint s) const { return s >= first && s < end(); }
  };

  // settings

  int type;
  class Region *region = nullptr;    // null: the whole box
  class MPMField *fix = nullptr;     // field whose lattice the sites refer to; null: none
  double origin[3];

  // derived

  int group_bits = 0;    // bit of the group of keyword group
  double volume;         // of a point, or the mean of all
  Range box[3];          // sites in the simulation box
  Range search[3];       // sites that can be in the region, also outside of the box
  std::unique_ptr<class MPMRegionCut> region_cut;    // with keyword cut, else null
  int split_variable = -1;                           // index, -1: none
  int place_variable[3] = {-1, -1, -1};
  /** Sites on the surface of the region where another body has points: they belong to that one. */
  std::set<std::array<bigint, 3>> taken;
  mutable bigint beyond_box = 0;    // points of divided sites that would be outside of the box

  // of an image

  struct Field {    // a quantity that is set to scale * gray value + offset
    double scale, offset;
  };
  std::unique_ptr<MPM_NS::ImageBody> image;    // null: none
  bool sites_on_pixels = false;
  std::vector<Field> fields;
  std::unique_ptr<class MPMPointColumns> field_columns;    // the quantities of fields; null: none
  std::vector<double> grays;    // gray values of the points made here, for fields

  std::unique_ptr<CreatePointsMesh> mesh;            // null: none
  std::unique_ptr<class CreatePointsTable> table;    // null: none
  std::vector<double> table_rows;                    // of the points made here

  void parse(int, char **);
  void parse_mesh(int, char **);
  void parse_image(int, char **);
  void parse_table(int, char **);
  void place_sites(const MPM_NS::Options &);
  void find_group(const MPM_NS::Options &, const std::string &name);
  int owner(double *x) const;
  tagint largest_tag() const;
  void check_tags(tagint largest, bigint nmore) const;
  void find_lattice();
  void find_ranges();
  bool is_countable() const;
  void begin_cut();
  void check_outside();
  bool same_body(int i) const;
  void check_overlap();
  bool is_inside(const double *x) const;
  bigint ranges_in_box(Range *) const;
  void check_units_of_region() const;
  void note_round() const;
  bigint make_points();
  bigint make_mesh_points();
  bigint make_table_points();
  void send_and_make(std::vector<Site> &);
  void set_fields(int first);
  void set_columns(int first);
  void look_at_image(const bigint *s, Site &) const;
  std::string types_made(int first) const;
  void make_point(Site);

  double position(int d, bigint s) const { return origin[d] + (s + 0.5) * spacing[d]; }
  bool in_box(const bigint *s) const
  {
    return box[0].contains(s[0]) && box[1].contains(s[1]) && box[2].contains(s[2]);
  }
  double volume_fraction(const bigint *s) const;
  double surface_share(const bigint *s) const;
  void find_split(const MPM_NS::Options &);
  void make_parts(const bigint *s, std::vector<Site> &) const;
  int divisions(const bigint *s) const;
  int for_parts(const bigint *s, const std::function<void(const double *x)> &visit) const;
  bigint make_relaxed_points();
  void add_relaxed_site(const bigint *s, const bigint *first, MPM_NS::RelaxedPoints &) const;
  bool in_region(const bigint *s) const { return volume_fraction(s) > 0.0; }
  bool cut_site(const bigint *s, Site &) const;
  void point_position(const bigint *s, double *x) const;
  void for_sites(const Range *range, bigint first, bigint last,
                 const std::function<void(const bigint *s)> &visit) const;
};

}    // namespace LAMMPS_NS
#endif
#endif
