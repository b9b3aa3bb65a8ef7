// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_REFINE_TESTING_H
#define MPM_REFINE_TESTING_H

// Bodies on lattices of several spacings, for tests of fix mpm/refine.

#include "mpm_lammps.h"

namespace MPM_TEST {

/** Origin of a lattice this many levels finer than one with spacing 1 and its origin at zero. */
inline double origin(const std::string &shape, int level)
{
  double at = 0.0;
  for (int k = 0; k < level; k++)
    if (shape == "quadratic") at += 0.25 / (1 << k);
  return at;
}

/** Input of fields F0, F1, ... of points of types 1, 2, ..., each with half the spacing of the
 *  last. regions: of each field, as in region. Points fill it outside of the region of the next. */
inline std::string lattices(int dim, const std::string &shape, const std::string &options,
                            const std::vector<std::string> &regions)
{
  std::string head, points, all;
  for (int k = 0; k < (int) regions.size(); k++) {
    const double o = origin(shape, k);
    head += strprintf("group g%d type %d\nfix F%d g%d mpm %.17g shape %s %s origin %.17g %.17g", k,
                      k + 1, k, k, 1.0 / (1 << k), shape.c_str(), options.c_str(), o, o) +
        (dim == 3 ? strprintf(" %.17g\n", o) : "\n");
    std::string inner;
    if (k + 1 < (int) regions.size()) {    // without the region of the finer field
      points += strprintf("region h%d %s side out\nregion b%d %s\nregion r%d intersect 2 b%d h%d\n",
                          k, regions[k + 1].c_str(), k, regions[k].c_str(), k, k, k);
    } else {
      points += strprintf("region r%d %s\n", k, regions[k].c_str());
    }
    points += strprintf("create_points %d region r%d ppc 2 fix F%d\ngroup g%d type %d\n", k + 1, k,
                        k, k, k + 1);
    all += strprintf(" F%d", k);
  }
  return head + "fix one all mpm/refine" + all + "\n" + points;
}

/** Input of nested rectangles (3d: boxes), each on a lattice of its own. levels: 1 to 3 of them. */
inline std::string nested(int dim, int levels, const std::string &shape, const std::string &options)
{
  std::vector<std::string> all = {"block 0 12 0 11 ", "block 3 10 3 9 ", "block 4 8 5 8 "};
  static const char *const along_z[] = {"0 9", "2 7", "3 6"};
  for (int k = 0; k < 3; k++) all[k] += dim == 3 ? along_z[k] : "INF INF";
  all.resize(levels);
  return lattices(dim, shape, options, all);
}

/** Only the fix commands of a scene, for a run after a restart. */
inline std::string without_points(const std::string &scene)
{
  std::string again;
  for (std::size_t at = 0, end; at < scene.size(); at = end + 1) {
    end = scene.find('\n', at);
    const std::string line = scene.substr(at, end - at);
    if (line.find("fix ") == 0) again += line + "\n";
  }
  return again;
}

}    // namespace MPM_TEST
#endif
