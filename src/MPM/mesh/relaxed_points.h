/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_RELAXED_POINTS_H
#define MPM_MESH_RELAXED_POINTS_H

// Points that share the volume of a body and follow its surface. Nothing here knows about LAMMPS.

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace MPM_NS {

/** Points of a body, each at the center of its own cell, where all cells have the wanted volumes.
 *
 *  The cell of a point is the part of the body that is nearest to it, where a weight of the point
 *  is subtracted from squared distances (power cells). In turn, points move to the centers of their
 *  cells (S. P. Lloyd, IEEE Trans. Inf. Theory 28 (1982) 129), and weights of points whose cells
 *  are too small grow (F. Aurenhammer et al., Algorithmica 20 (1998) 61). In this way the outer
 *  points arrange themselves in layers along the surface.
 *
 *  The body consists of samples on a lattice that divides each site. All computations use integers:
 *  lengths in UNIT, which is 2^-16 of a site (along each axis, of its own spacing), and volumes in
 *  SITE, which is 2^-36 of the volume of a site. So sums over samples are the same however the
 *  samples are spread over processes. All processes have all points, and each has some of the
 *  samples. */
class RelaxedPoints {
 public:
  static constexpr int64_t UNIT = (int64_t) 1 << 16;          ///< length of a site in these units
  static constexpr int64_t SITE = (int64_t) 1 << 36;          ///< volume of a site in these units
  static constexpr int64_t MOST_SITES = (int64_t) 1 << 20;    ///< sites along an axis
  using Place = std::array<int64_t, 3>;
  using Sum = std::function<void(std::vector<int64_t> &)>;    ///< sums over all processes, in place

  /** The lattice has sites 0 to n - 1 along each axis; in 2d there is one along z. periodic: site n
   *  is site 0 again. */
  RelaxedPoints(int dim, const Place &n, const std::array<bool, 3> &periodic) :
      dim(dim), n(n), periodic(periodic)
  {
  }

  /** Adds a point at x, in sites. share: the share of the volume that it should have, relative to
   *  the shares of the others. Must be the same on all processes. */
  void add_point(const double *x, double share);

  /** Place of sample k of m along each axis in its site, along axis d. Samples do not lie in rows:
   *  each is displaced within its part of the site such that no two have the same place along any
   *  axis. So a cell that grows a little gains only a few samples at a time. */
  static int64_t sample(int dim, int m, const int *k, int d);

  /** Adds the samples of a site: m along each axis, an even number. Samples with a mark belong to
   *  the body (sample i, j, k has the mark i + m (j + m k); no marks: all samples do). Together
   *  they have this volume, and they are displaced by move. */
  void add_site(const Place &site, int m, const std::vector<char> &marks, int64_t volume,
                const Place &move);

  /** Moves the points this many times. Returns false if any samples are farther than REACH sites
   *  from all points. */
  bool relax(int times, const Sum &);
  static constexpr int REACH = 4;

  std::size_t size() const { return points.size(); }
  std::array<double, 3> center(std::size_t) const;    ///< center of the cell of a point, in sites
  double volume(std::size_t k) const { return (double) points[k].volume / (double) SITE; }

  double scatter = 0.0;    ///< largest relative difference of a volume from the wanted one
  double moved = 0.0;      ///< largest displacement of a point in the last step, in sites

 private:
  struct Point {
    Place x;
    double share;
    int64_t weight = 0;          // UNIT^2
    int64_t volume = 0;          // of the cell in SITE,
    Place moment = {0, 0, 0};    // and the integral of the distance from x over it
  };
  struct Site {
    Place corner;
    int m;
    int64_t volume;       // of a sample
    std::size_t marks;    // where its marks begin; ALL: all samples are of the body
  };
  struct Near {    // a periodic image of a point within reach of a site
    int index;
    Place x;
    int64_t weight;
  };
  struct Box {    // a range of samples of a site
    int lo[3], hi[3];
  };
  static constexpr std::size_t ALL = ~(std::size_t) 0;
  int dim;
  Place n;
  std::array<bool, 3> periodic;
  std::vector<Point> points;
  std::vector<Site> sites;
  std::vector<char> marks;
  std::vector<std::pair<int64_t, int>> order;    // points sorted by the site that they are in
  double shares = 0.0;
  int64_t most_weight = 0;
  bool lost = false;

  void find_cells(const Sum &);
  void sort_points();
  void list_near(const Site &, int reach, std::vector<Near> &) const;
  bool find_near(const Site &, std::vector<Near> &) const;
  void share_box(const Site &, const Box &, std::vector<Near> &, std::size_t first);
  void share_samples(const Site &, const Box &, const Near *begin, const Near *end);
};

}    // namespace MPM_NS
#endif
