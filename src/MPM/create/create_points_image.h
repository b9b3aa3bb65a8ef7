/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_CREATE_POINTS_IMAGE_H
#define LMP_CREATE_POINTS_IMAGE_H

// create_points TYPE image FILE: keywords for the image, and the image itself on all ranks.

#include "declare/option.h"
#include "image/body.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class LAMMPS;

/** Keywords of create_points for images, in addition to those for regions. */
struct CreatePointsImageOptions {
  double pixel[3] = {0.0, 0.0, 0.0};    ///< size of a pixel; 0: as in the file
  double origin[3] = {0.0, 0.0, 0.0};
  /** Axes of the box with signs for columns, rows, slices; empty: by format. */
  std::string axes[3];
  double threshold = 0.0;
  bool invert = false;
  std::vector<std::pair<double, std::string>> from;    ///< types, each from a gray value on
  std::vector<std::pair<std::array<int, 3>, std::string>> colors;
  bool on_pixels = false;
  double smooth = 0.0;
  std::string region_id;
  MPM_NS::RawLayout raw;
  MPM_NS::SliceRange slices;

  /** Values of pixels into a vector of fix property/atom or a history variable. */
  struct Field {
    std::string name;
    double scale, offset;
  };
  std::vector<Field> fields;

  void add_to(MPM_NS::Options &, int dimension);
  MPM_NS::OptionRules rules() const;
  /** The keywords of this struct alone, for the manual. */
  MPM_NS::Options declare(int dimension);

 private:
  Field field;
  double from_value;
  int color[3];
  std::string from_type, color_type;
};

/** Reads the image on rank 0, places it in the box, and sends the part in the box to all ranks.
 *  Stops with an error if the image is not valid. type: of the points; file: its name, which is
 *  arg[2] of the command. */
std::unique_ptr<MPM_NS::ImageBody> read_image_body(LAMMPS *, const CreatePointsImageOptions &,
                                                   const MPM_NS::Options &, int type,
                                                   const char *file);

}    // namespace LAMMPS_NS
#endif
