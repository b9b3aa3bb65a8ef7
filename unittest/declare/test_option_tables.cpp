// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit docs

// The keywords of all styles in the manual are those that the styles declare: a page includes
// options/PAGE.inc, and options/PAGE_default.inc for the defaults.

#include "declare/option_manual.h"
#include "declare/table_testing.h"

#include "contact/fix_mpm_contact.h"
#include "contact/fix_mpm_rigid.h"
#include "contact/pair_mpm_penalty.h"
#include "create/create_points.h"
#include "create/create_points_image.h"
#include "create/create_points_table.h"
#include "elements/fix_mpm_airbag.h"
#include "elements/fix_mpm_elements.h"
#include "elements/pair_mpm_sheet.h"
#include "field/mpm_field_options.h"
#include "flow/mpm_flow_options.h"
#include "fracture/fix_mpm_fracture.h"
#include "fracture/fix_mpm_phasefield.h"
#include "grains/fix_mpm_handshake.h"
#include "grains/fix_mpm_immersed.h"
#include "grains/fix_mpm_surface.h"
#include "heat/fix_mpm_heat.h"
#include "implicit/fix_mpm_deform.h"
#include "implicit/fix_mpm_relax.h"
#include "implicit/mpm_implicit_options.h"
#include "loads/fix_mpm_absorb.h"
#include "loads/fix_mpm_dashpot.h"
#include "loads/fix_mpm_emit.h"
#include "loads/fix_mpm_pml.h"
#include "loads/fix_mpm_traction.h"
#include "meshgrid/fix_mpm_mesh.h"
#include "meshgrid/fix_mpm_mesh_contact.h"
#include "meshgrid/fix_mpm_mesh_heat.h"
#include "output/compute_mpm_fragment.h"
#include "output/compute_mpm_jintegral.h"
#include "output/fix_mpm_record.h"
#include "output/mpm_point.h"
#include "pore/fix_mpm_mixture.h"
#include "pore/fix_mpm_pore.h"
#include "step/fix_mpm_dt.h"
#include "walls/fix_mpm_boundary.h"
#include "walls/region_mpm_mesh.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

static std::map<std::string, std::string> files()
{
  std::map<std::string, std::string> all;
  const auto add = [&](const std::string &page, const Options &o) {
    const std::string from =
        ".. made from the declaration of the options by test_option_tables\n\n";
    all[page + ".inc"] = from + MPM_TEST::table(o);
    all[page + "_default.inc"] = from + MPM_TEST::defaults(o);
  };
  add("create_points", CreatePointsOptions().declare(3, true));
  add("create_points_image", CreatePointsImageOptions().declare(3));
  add("create_points_table", CreatePointsTableOptions().declare(3, true));
  add("create_points_mesh", CreatePointsMeshOptions().declare("create_points mesh", 3, true, true));
  add("compute_mpm_fragment", MPMFragmentOptions().declare());
  add("compute_mpm_jintegral", MPMJIntegralOptions().declare(3));
  add("fix_mpm", MPMFieldOptions().declare(3));
  add("fix_mpm_airbag", MPMAirbagOptions().declare());
  add("fix_mpm_boundary", MPMBoundaryOptions().declare(3));
  add("fix_mpm_contact", MPMContactOptions().declare());
  add("fix_mpm_dt", MPMDtOptions().declare());
  add("fix_mpm_elements", MPMElementsOptions().declare(3));
  add("fix_mpm_fracture", MPMFractureOptions().declare());
  add("fix_mpm_phasefield", MPMPhaseFieldOptions().declare());
  add("fix_mpm_handshake", MPMHandshakeOptions().declare());
  add("fix_mpm_heat", MPMHeatOptions().declare(3));
  add("fix_mpm_immersed", MPMImmersedOptions().declare(3));
  add("fix_mpm_incompressible", MPMIncompressibleOptions().declare(3));
  add("fix_mpm_mesh", MPMMeshOptions().declare(3));
  add("fix_mpm_mesh_contact", MPMMeshContactOptions().declare());
  add("fix_mpm_mesh_heat", MPMMeshHeatOptions().declare());
  add("fix_mpm_mixture", MPMMixtureOptions().declare());
  add("fix_mpm_pore", MPMPoreOptions().declare(3));
  add("fix_mpm_implicit", MPMImplicitOptions().declare());
  add("fix_mpm_relax", MPMRelaxOptions().declare());
  add("fix_mpm_rigid", MPMRigidOptions().declare());
  add("fix_mpm_surface", MPMSurfaceOptions().declare());
  add("fix_mpm_dashpot", MPMDashpotOptions().declare(3));
  add("fix_mpm_pml", MPMPMLOptions().declare(3));
  add("fix_mpm_deform", MPMDeformOptions().declare(3));
  add("fix_mpm_traction", MPMTractionOptions().declare(3));
  add("fix_mpm_emit", MPMEmitOptions().declare(3));
  add("fix_mpm_absorb", MPMAbsorbOptions().declare());
  add("fix_mpm_record", MPMRecordOptions().declare());
  add("mpm_point", MPMPointOptions().declare());
  add("pair_mpm_penalty", MPMPenaltyOptions().declare());
  add("pair_mpm_penalty_coeff", MPMPenaltyCoeff().declare());
  add("pair_mpm_sheet", MPMSheetOptions().declare());
  add("pair_mpm_sheet_coeff", MPMSheetCoeff().declare());
  add("region_mpm_mesh", MPMRegionMeshOptions().declare());
  return all;
}

TEST(OptionTables, AreUpToDate)
{
  MPM_TEST::expect_up_to_date("options", files());
}

TEST(OptionTables, AreInTheirPages)
{
  const std::string folder = MPM_SOURCE_DIR "/doc/src/";
  for (const auto &[file, text] : files()) {
    std::string page = file.substr(0, file.size() - 4);
    for (const std::string end : {"_default", "_coeff", "_image", "_mesh", "_table"})
      if (page != "region_mpm_mesh" && page != "fix_mpm_mesh" && page.size() > end.size() &&
          page.compare(page.size() - end.size(), end.size(), end) == 0)
        page.resize(page.size() - end.size());
    EXPECT_NE(
        MPM_TEST::text_of_file(folder + page + ".rst").find(".. include:: options/" + file + "\n"),
        std::string::npos)
        << "doc/src/" << page << ".rst does not include options/" << file;
  }
}
