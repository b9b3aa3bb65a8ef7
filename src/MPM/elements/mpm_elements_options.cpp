/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/mpm_elements_options.h"

#include "law/axes.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

Options MPMElementsOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/elements");
  o.argument(text(file, "file"));
  o.add("part",
        {text(part, "name", "name or tag of a physical group of the mesh, as in create_points")})
      .standard("all elements of the dimension of the simulation");
  o.add("locking", {word(fbar, {{"none", false}, {"fbar", true}})},
        "quantity that is averaged over an element to prevent volumetric locking");
  thin.declare(o, dim);
  o.add("compression", {word(compression, {{"yes", true}, {"no", false}})},
        "whether surfaces and lines resist compression (no: they wrinkle and sag)");
  o.add("bending",
        {word(bending, {{"no", Body::NONE}, {"yes", Body::CONSTANT}, {"linear", Body::LINEAR}})},
        "whether surfaces of triangles, and lines, resist bending like elastic plates and rods; "
        "linear: with a curvature that changes within triangles");
  o.add("curved", {yes_no(curved)},
        "whether closed surfaces of triangles (2d: of lines) represent the curved surface through "
        "their nodes");
  o.add("axes",
        {numbers(axes, 6, "a1x a1y a1z a2x a2y a2z", ANY_NUMBER, "",
                 "axis 1 of the material, and a vector on the side of axis 2, on the undeformed "
                 "surface in 3d")})
      .then([this] {
        has_axes = true;
      })
      .standard("an isotropic material");
  o.refuse([this, dim] {
    auto rules = thin.rules();
    const char *const wrong = has_axes ? law::check_axes(axes, axes + 3) : nullptr;
    rules.push_back({curved && thin.dimension(dim) != dim - 1, "curved",
                     "is for closed surfaces: use thickness"});
    rules.push_back({has_axes && thin.dimension(dim) != 2, "axes",
                     "is for surfaces in 3d, which have a thickness"});
    rules.push_back({has_axes && (bending || !compression), "axes",
                     "is not for bending, nor for compression no, for which the material must be "
                     "isotropic"});
    rules.push_back({wrong != nullptr, "axes", "needs two vectors that are not parallel"});
    rules.push_back(
        {bending && !thin, "bending", "is for surfaces and lines: use thickness or section"});
    rules.push_back({bending == Body::LINEAR && thin.dimension(dim) != 2, "bending",
                     "linear is for surfaces in 3d: use bending yes"});
    rules.push_back(
        {bending && !compression, "bending",
         "and compression no exclude each other: what wrinkles does not resist bending"});
    rules.push_back({!compression && !thin, "compression",
                     "no is for surfaces and lines: use thickness or section"});
    rules.push_back({fbar && thin, "locking", "fbar is for solids, not for surfaces and lines"});
    return rules;
  });
  return o;
}
