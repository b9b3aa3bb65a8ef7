/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// A step of a material: the order in which its laws work on a batch.

#include "law/damage.h"
#include "material/composed_material.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace MPM_NS;

namespace {

/** The solid part of points that melt and solidify. It fills the fraction s of their volume and
 *  bears the whole deviator S = s S_s of their stress, where S_s is the deviator in the solid.
 *  Melting removes the elastic shear of the molten part and leaves S_s unchanged. Newly formed
 *  solid is free of shear, which leaves S unchanged. The history of solid that melts is lost; newly
 *  formed solid has a new history, and the point keeps the mean over its solid.
 */
class MeltingSolid {
 public:
  double share[BATCH];     ///< volume fraction of the solid now
  bool changes = false;    ///< does the fraction of any point change in this step?
  bool complete = true;    ///< are all points completely solid, before and now?
  double before[BATCH];    ///< volume fraction of the solid at the start of the step

  /** was: row with the solid fraction to which the stress belongs; molten: row with the molten
   *  fraction. */
  MeltingSolid(const Batch &b, const double *was, const double *molten)
  {
    for (int i = 0; i < b.n; i++) {
      before[i] = was[i];
      share[i] = std::max(1.0 - molten[i], 0.0);
      changes = changes || share[i] != before[i];
      complete = complete && share[i] == 1.0 && before[i] == 1.0;
    }
  }

  /** Factor from the stress deviator of the point at the start of the step to that of its solid
   *  now; 0 if the point is completely molten. */
  double to_solid(int i) const
  {
    return share[i] > 0.0 ? 1.0 / std::max(share[i], before[i]) : 0.0;
  }
  /** Fraction of its history that the solid keeps. */
  double kept(int i) const
  {
    return share[i] > before[i] ? before[i] / share[i] : share[i] > 0.0 ? 1.0 : 0.0;
  }
};

/** While this object exists, the laws count their work only for a fraction of the volume of each
 *  point. */
class ShareOfVolume {
 public:
  ShareOfVolume(Batch &b, const double *share) : vol0(b.vol0)
  {
    for (int i = 0; i < b.n; i++) b.vol0[i] = share[i] * vol0.was[i];
  }

 private:
  Restored<double[BATCH]> vol0;
};

}    // namespace

void ComposedMaterial::initial_stress(Batch &b) const
{
  b.dt = 0.0;
  for (int i = 0; i < b.n; i++) {
    b.heat[i] = b.plastic[i] = 0.0;
    b.Jold[i] = b.J[i];
  }
  for (auto &row : b.A) std::fill(row, row + b.n, 0.0);
  clear_stress(b);
  if (eos && eos->info->finds_temperature) {
    // what had burnt from the start is warm without that anything has been conducted
    run_eos(b, nullptr);
    remember_heat(b);
    for (int i = 0; i < b.n && damage; i++)
      b.history[damage->history + law::REST_ENERGY][i] = internal_energy(&b.history[0][i], BATCH);
    return;
  }
  if (!expands) {
    run(eos, b);
    return;
  }
  const ElasticMotion motion(b, stretch_of(b), shape_matters);
  run(eos, b);
}

bool ComposedMaterial::has_tangent() const
{
  if (damage || solid >= 0) return false;
  // a compression that warms, and so expands
  const int gruneisen = expands ? thermal->info->gruneisen : -1;
  if (gruneisen >= 0 && thermal->parameters.value[gruneisen] != 0.0) return false;
  return std::all_of(laws.begin(), laws.end(), [](const auto &law) {
    return law.part == THERMAL || law.kernels->tangent;
  });
}

void ComposedMaterial::update_with_tangent(Batch &b, Tangent &t) const
{
  for (int l = 0; l < 9; l++) {
    if (t.skips(l)) continue;
    for (auto &component : t.stress) std::fill_n(component[l], b.n, 0.0);
    std::fill_n(t.heat[l], b.n, 0.0);
  }
  update(b, &t);
}

void ComposedMaterial::elastic_speed(const Batch &state, double *c) const
{
  Batch copy;
  const Batch &b = without_viscous_stress(state, copy);
  if (expands)
    expanded_speed(b, c);
  else
    plain_speed(b, c);
}

void ComposedMaterial::raise_speed(const Batch &b, double *c) const
{
  for (const auto &law : laws) {
    if (!law.kernels->raise_speed) continue;
    double solid_speed[BATCH];
    if (law.liquid) std::copy(c, c + b.n, solid_speed);
    call(law.kernels->raise_speed, law, b, c);
    for (int i = 0; law.liquid && i < b.n; i++)
      if (b.history[solid][i] >= 1.0) c[i] = solid_speed[i];
  }
}

void ComposedMaterial::stored_energy(const Batch &state, double *w) const
{
  if (!expands) {
    energy_of_laws(state, w);
    return;
  }
  Batch b = state;
  const ThermalStretch s = stretch_of(b);
  const ElasticMotion motion(b, s, shape_matters);
  energy_of_laws(b, w);
  for (int i = 0; i < b.n; i++) w[i] *= s.volume(i);
}

// a step

void ComposedMaterial::update(Batch &b, Tangent *t) const
{
  if (stress_temperature >= 0) {
    update_by_temperature(b, t);
    return;
  }
  make_stress(b, t);
  find_temperature(b);
}

void ComposedMaterial::make_stress(Batch &b, Tangent *t) const
{
  double outside[BATCH];
  for (int i = 0; i < b.n; i++) {
    outside[i] = b.heat[i];
    b.heat[i] = b.plastic[i] = 0.0;
  }
  for (double &w : b.work) w = 0.0;

  if (damage) call(damage->kernels->prepare, *damage, b);
  take_viscous_stress(b);
  if (speed_matters) plain_speed(b, b.speed);
  if (!base) clear_stress(b);
  if (solid < 0)
    run(base, b, t);
  else
    run_solid(b);
  if (damage) account_of_strength(b);
  for (int i = 0; i < b.n; i++) {
    b.heat[i] += outside[i];
    b.work[VISCOUS] += b.vol0[i] * outside[i];
  }
  // what viscosities add: stress after them minus stress before them
  with_viscous_stress(b, [](double stress, double &added) {
    added = -stress;
  });
  for (const auto &law : laws)
    if (law.liquid)
      run_liquid(law, b);
    else if (law.part == VISCOSITY)
      run(&law, b, t);
  with_viscous_stress(b, [](double stress, double &added) {
    added += stress;
  });
  if (damage) table->mean_stress(b, b.viscous_mean);
  run_eos(b, t);
  if (damage) add_energy(eos, b, b.volume_energy);
  run_damage(b);
}

void ComposedMaterial::find_temperature(Batch &b) const
{
  run(thermal, b);
  remember_heat(b);
}

void ComposedMaterial::run_damage(Batch &b) const
{
  if (!damage) return;
  double before[BATCH];
  if (unspent_heat >= 0) std::copy_n(b.heat, b.n, before);
  run(damage, b);
  // what a slip of failed points releases is no longer there in the next step
  if (const int kept = base->info->energy_kept; kept >= 0)
    std::copy_n(rows(b, *damage)[law::SHEAR_ENERGY], b.n, b.history[base->history + kept]);
  if (unspent_heat < 0) return;
  double *const rest = b.history[unspent_heat];
  for (int i = 0; i < b.n; i++) rest[i] += b.heat[i] - before[i];
}

void ComposedMaterial::run_eos(Batch &b, Tangent *t) const
{
  if (heated < 0 && unspent_heat < 0) {
    run(eos, b, t);
    return;
  }
  double own[BATCH], brought[BATCH] = {};
  if (heated >= 0) find_conducted_heat(b, brought);
  if (unspent_heat >= 0) spend_heat(b, brought);
  if (eos->info->finds_temperature) {
    // the temperature at the start, which has this heat, belongs to the energy at the start
    double *const energy = b.history[eos->history], *const heat = b.history[eos->history + 1];
    for (int i = 0; i < b.n; i++) {
      energy[i] += brought[i];
      heat[i] += brought[i];
    }
    run(eos, b, t);
    return;
  }
  std::copy_n(b.heat, b.n, own);
  for (int i = 0; i < b.n; i++) b.heat[i] += brought[i];
  run(eos, b, t);
  std::copy_n(own, b.n, b.heat);
}

void ComposedMaterial::account_of_strength(Batch &b) const
{
  for (int i = 0; i < b.n; i++) {
    b.plastic_work[i] = b.heat[i];
    b.heat[i] *= damage->parameters.chi * b.kept[i];
    b.shear_energy[i] = b.volume_energy[i] = 0.0;
  }
  if (random_heat) {
    LocalParameters local(*this, *damage);
    for (int i = 0; i < b.n; i++)
      b.heat[i] = local.at(&b.history[0][i], BATCH).chi * b.kept[i] * b.plastic_work[i];
  }
  add_energy(base, b, b.shear_energy);
}

void ComposedMaterial::plain_speed(const Batch &b, double *c) const
{
  double k[BATCH] = {};
  for (const auto &law : laws) {
    if (!law.kernels->modulus) continue;
    if (law.part != STRENGTH || solid < 0) {
      call(law.kernels->modulus, law, b, k);
      continue;
    }
    double strong[BATCH] = {};
    call(law.kernels->modulus, law, b, strong);
    for (int i = 0; i < b.n; i++) k[i] += b.history[solid][i] * strong[i];
  }
  table->speed(b.n, rho_pressure, k, c);
  if (random_density)
    for (int i = 0; i < b.n; i++) c[i] /= std::sqrt(b.history[random_density->row][i]);
}

void ComposedMaterial::energy_of_laws(const Batch &state, double *w) const
{
  Batch copy;
  const Batch &b = without_viscous_stress(state, copy);
  for (int i = 0; i < b.n; i++) w[i] = 0.0;
  for (const auto &law : laws)
    if (law.part == STRENGTH && solid >= 0)
      add_energy_of_solid(b, w);
    else if (!(damage && law.part == STRENGTH))
      add_energy(&law, b, w);
}

void ComposedMaterial::add_energy(const UsedLaw *law, const Batch &b, double *w) const
{
  if (law && law->kernels->energy) call(law->kernels->energy, *law, b, w);
}

// solids that melt

void ComposedMaterial::melt_and_solidify()
{
  if (std::none_of(laws.begin(), laws.end(), [](const auto &law) {
        return law.liquid;
      }))
    return;
  solid = variables.size();
  molten = std::find_if(variables.begin(), variables.end(),
                        [](const auto &variable) {
                          return variable.name == "molten";
                        }) -
      variables.begin();
  variables.push_back({"solid", 1.0});
}

void ComposedMaterial::run_solid(Batch &b) const
{
  double *const was = b.history[solid];
  const MeltingSolid part(b, was, b.history[molten]);
  if (part.complete) {
    run(base, b);
    return;
  }
  double lost[BATCH] = {}, rest[BATCH] = {};
  if (part.changes) add_energy_of_solid(b, lost);
  for (int i = 0; i < b.n; i++) was[i] = part.share[i];
  for (auto &row : b.stress)
    for (int i = 0; i < b.n; i++) row[i] *= part.to_solid(i);
  // what is left of the history when a share of it is kept
  const LawInfo &info = *base->info;
  const int first = base->history,
            last = first + info.count_history(base->parameters) +
      info.nterm_history * base->parameters.nterms;
  const auto keep = [&](int i, double share) {
    for (int k = first; k < last; k++) {
      double &h = b.history[k][i];
      h = variables[k].initial + share * (h - variables[k].initial);
    }
  };
  if (part.changes) {
    for (int i = 0; i < b.n; i++) keep(i, part.kept(i));
    add_energy(base, b, rest);
    for (int i = 0; i < b.n; i++) {
      lost[i] -= part.share[i] * rest[i];
      b.work[PLASTIC] += b.vol0[i] * lost[i];
      b.work[HEAT] += b.vol0[i] * lost[i];
    }
  }
  {
    const ShareOfVolume volume(b, part.share);
    run(base, b);
  }
  for (int i = 0; i < b.n; i++)
    if (part.share[i] == 0.0) keep(i, 0.0);
  for (auto &row : b.stress)
    for (int i = 0; i < b.n; i++) row[i] *= part.share[i];
  for (int i = 0; i < b.n; i++) b.heat[i] = part.share[i] * b.heat[i] + lost[i];
}

void ComposedMaterial::add_energy_of_solid(const Batch &state, double *w) const
{
  const double *const share = state.history[solid];
  Batch b = state;
  double whole[BATCH] = {};
  for (auto &row : b.stress)
    for (int i = 0; i < b.n; i++) row[i] = share[i] > 0.0 ? row[i] / share[i] : 0.0;
  add_energy(base, b, whole);
  for (int i = 0; i < b.n; i++) w[i] += share[i] * whole[i];
}

void ComposedMaterial::run_liquid(const UsedLaw &law, Batch &b) const
{
  double share[BATCH], heat[BATCH], stress[6][BATCH];
  bool any = false;
  for (int i = 0; i < b.n; i++) {
    share[i] = 1.0 - b.history[solid][i];
    any = any || share[i] > 0.0;
  }
  if (!any) return;
  std::copy(b.heat, b.heat + b.n, heat);
  memcpy(stress, b.stress, sizeof(stress));
  {
    const ShareOfVolume volume(b, share);
    run(&law, b);
  }
  for (int i = 0; i < b.n; i++) b.heat[i] = heat[i] + share[i] * (b.heat[i] - heat[i]);
  for (int k = 0; k < 6; k++)
    for (int i = 0; i < b.n; i++)
      b.stress[k][i] = stress[k][i] + share[i] * (b.stress[k][i] - stress[k][i]);
}

// viscous stress

template <class Work> void ComposedMaterial::with_viscous_stress(Batch &b, Work work) const
{
  for (int k = 0; viscous >= 0 && k < 6; k++)
    for (int i = 0; i < b.n; i++) work(b.stress[k][i], b.history[viscous + k][i]);
}

void ComposedMaterial::take_viscous_stress(Batch &b) const
{
  with_viscous_stress(b, [](double &stress, double added) {
    stress -= added;
  });
}

const Batch &ComposedMaterial::without_viscous_stress(const Batch &b, Batch &copy) const
{
  if (viscous < 0) return b;
  copy = b;
  take_viscous_stress(copy);
  return copy;
}

// kernels, of all points or one by one

template <class Work>
void ComposedMaterial::one_by_one(const UsedLaw &law, const Batch &b, Work work) const
{
  Batch one;
  one.n = 1;
  one.dt = b.dt;
  one.h = b.h;
  one.time = b.time;
  LocalParameters local(*this, law);
  for (int i = 0; i < b.n; i++) {
    for (int k = 0; k < 9; k++) one.A[k][0] = b.A[k][i];
    for (int k = 0; k < 9; k++) one.F[k][0] = b.F[k][i];
    for (int k = 0; k < 6; k++) one.stress[k][0] = b.stress[k][i];
    for (double &w : one.work) w = 0.0;
    for (const auto row : single_rows) (one.*row)[0] = (b.*row)[i];
    one.history = reinterpret_cast<History>(&b.history[0][i]);
    work(local.at(&b.history[0][i], BATCH), one, one.history + law.history, i);
  }
}

void ComposedMaterial::take_back(const Batch &one, int i, Batch &b)
{
  for (int k = 0; k < 6; k++) b.stress[k][i] = one.stress[k][0];
  for (const auto row : single_rows) (b.*row)[i] = (one.*row)[0];
  for (int k = 0; k < NWORK; k++) b.work[k] += one.work[k];
}

void ComposedMaterial::call(void (*kernel)(const LawParameters &, Batch &, History),
                            const UsedLaw &law, Batch &b) const
{
  if (!law.varies) {
    kernel(law.parameters, b, rows(b, law));
    return;
  }
  one_by_one(law, b, [&](const LawParameters &p, Batch &one, History history, int i) {
    kernel(p, one, history);
    take_back(one, i, b);
  });
}

void ComposedMaterial::call(void (*kernel)(const LawParameters &, const Batch &, History, double *),
                            const UsedLaw &law, const Batch &b, double *value) const
{
  if (!law.varies)
    kernel(law.parameters, b, rows(b, law), value);
  else
    one_by_one(law, b, [&](const LawParameters &p, const Batch &one, History history, int i) {
      kernel(p, one, history, value + i);
    });
}

void ComposedMaterial::run(const UsedLaw *law, Batch &b) const
{
  if (law) call(law->kernels->update, *law, b);
}

void ComposedMaterial::run(const UsedLaw *law, Batch &b, Tangent *t) const
{
  if (!t) {
    run(law, b);
  } else if (law && !law->varies) {
    law->kernels->tangent(law->parameters, b, rows(b, *law), *t);
  } else if (law) {
    Tangent own;
    own.plane = t->plane;
    const auto copy = [](const Tangent &from, int i, Tangent &to, int j) {
      for (int l = 0; l < 9; l++) {
        if (from.skips(l)) continue;
        for (int k = 0; k < 6; k++) to.stress[k][l][j] = from.stress[k][l][i];
        to.heat[l][j] = from.heat[l][i];
      }
    };
    one_by_one(*law, b, [&](const LawParameters &p, Batch &one, History history, int i) {
      copy(*t, i, own, 0);
      law->kernels->tangent(p, one, history, own);
      copy(own, 0, *t, i);
      take_back(one, i, b);
    });
  }
}
