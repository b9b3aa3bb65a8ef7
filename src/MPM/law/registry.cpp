/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// All laws: those of the package, from law/list.h, and those that plugins have added.

#include "law/kernels.h"

#include <cstring>

using namespace MPM_NS;

namespace {

template <Part PART, class... Laws> void declare(law::Family<PART, Laws...>, LawList *laws)
{
  (laws[PART].push_back(law::declaration<Laws>()), ...);
}

struct Registry {
  LawList laws[NPARTS];
  std::size_t nbuiltin[NPARTS];
  std::deque<LawKernels> added[NPARTS];    ///< kernels of the laws behind the first nbuiltin

  Registry()
  {
#define MPM_DECLARE(family) declare(law::family(), laws);
    MPM_LAW_FAMILIES(MPM_DECLARE)
    for (int part = 0; part < NPARTS; part++) nbuiltin[part] = laws[part].size();
  }
};

Registry &registry()
{
  static Registry r;
  return r;
}

}    // namespace

const LawList &MPM_NS::declared_laws(Part part)
{
  return registry().laws[part];
}

/* ----------------------------------------------------------------------
   laws of a plugin, which may be loaded several times; deques leave the others where they are
------------------------------------------------------------------------- */

std::string MPM_NS::add_laws(const LawVersion &version, const PluginLaw *laws, int n)
{
  if (memcmp(&version, &law_version, sizeof(version)) != 0)
    return "it was compiled with the headers of another version of the MPM package: compile it "
           "again with those of this one";
  Registry &r = registry();
  for (int k = 0; k < n; k++) {
    const PluginLaw &law = laws[k];
    auto &list = r.laws[law.part];
    std::size_t same = 0;
    while (same < list.size() && strcmp(list[same].name, law.info.name) != 0) same++;
    if (same == list.size()) {
      list.push_back(law.info);
      r.added[law.part].push_back(law.kernels);
    } else if (same < r.nbuiltin[law.part] ||
               r.added[law.part][same - r.nbuiltin[law.part]].update != law.kernels.update) {
      return std::string("there is another law '") + law.info.name +
          "' already: give yours another name";
    }
  }
  return "";
}

/* ----------------------------------------------------------------------
   one table for each instruction set that the build has
------------------------------------------------------------------------- */

namespace MPM_NS {
#define MPM_DECLARE_KERNELS(family)         \
  FamilyKernels mpm_laws_##family##_base(); \
  FamilyKernels mpm_laws_##family##_v3();   \
  FamilyKernels mpm_laws_##family##_v4();
MPM_LAW_FAMILIES(MPM_DECLARE_KERNELS)
void mpm_laws_common_base(LawTable &);
void mpm_laws_common_v3(LawTable &);
void mpm_laws_common_v4(LawTable &);
}    // namespace MPM_NS

#define MPM_ADD_KERNELS(family, isa)                                 \
  {                                                                  \
    const LawKernels *kernels = mpm_laws_##family##_##isa().kernels; \
    auto &list = table.builtin[law::family::part];                   \
    list.insert(list.end(), kernels, kernels + law::family::size);   \
  }
#define MPM_ADD_BASE(family) MPM_ADD_KERNELS(family, base)
#define MPM_ADD_V3(family) MPM_ADD_KERNELS(family, v3)
#define MPM_ADD_V4(family) MPM_ADD_KERNELS(family, v4)

static LawTable make_base()
{
  LawTable table;
  mpm_laws_common_base(table);
  MPM_LAW_FAMILIES(MPM_ADD_BASE)
  return table;
}

#ifdef MPM_HAVE_V3
static LawTable make_v3()
{
  LawTable table;
  mpm_laws_common_v3(table);
  MPM_LAW_FAMILIES(MPM_ADD_V3)
  return table;
}
#endif

#ifdef MPM_HAVE_V4
static LawTable make_v4()
{
  LawTable table;
  mpm_laws_common_v4(table);
  MPM_LAW_FAMILIES(MPM_ADD_V4)
  return table;
}
#endif

/* ----------------------------------------------------------------------
   the transfer kernels decide which instruction set runs
------------------------------------------------------------------------- */

const LawTable *LawTable::select(const char *isa)
{
  const MPMKernels *chosen = MPMKernels::select(isa);
  if (!chosen) return nullptr;
#ifdef MPM_HAVE_V4
  static const LawTable v4 = make_v4();
  if (strcmp(chosen->isa, "AVX-512") == 0) return &v4;
#endif
#ifdef MPM_HAVE_V3
  static const LawTable v3 = make_v3();
  if (strcmp(chosen->isa, "AVX2") == 0) return &v3;
#endif
  static const LawTable base = make_base();
  return &base;
}

const LawKernels &LawTable::kernels(Part part, int index) const
{
  const int n = builtin[part].size();
  return index < n ? builtin[part][index] : registry().added[part][index - n];
}
