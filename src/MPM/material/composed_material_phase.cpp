/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "law/phase_field.h"
#include "material/composed_material.h"
#include "material/phase_field.h"

#include <algorithm>
#include <cstring>

using namespace MPM_NS;
using law::DamagePhaseField;
using law::PhaseField;

/** From the change of stress by a small uniaxial strain, so slow that rates do not matter. */
double ComposedMaterial::youngs_modulus() const
{
  constexpr double STRAIN = 1e-6, SLOW = 1e30;
  std::vector<double> initial, storage(variables.size() * BATCH);
  for (const auto &variable : variables) initial.push_back(variable.initial);
  const double x[3] = {0.0, 0.0, 0.0};
  initialize(x, initial.data());
  Batch b = {};
  b.n = 2;    // without and with strain
  b.h = 1.0;
  b.dt = SLOW;
  b.history = reinterpret_cast<History>(storage.data());
  for (int i = 0; i < b.n; i++) {
    for (std::size_t k = 0; k < initial.size(); k++) b.history[k][i] = initial[k];
    for (int k = 0; k < 9; k += 4) b.F[k][i] = 1.0;
    b.J[i] = b.Jold[i] = b.vol0[i] = 1.0;
  }
  b.F[0][1] = b.J[1] = 1.0 + STRAIN;
  b.A[0][1] = STRAIN;
  update(b);
  const double M = (b.stress[0][1] - b.stress[0][0]) / STRAIN;
  const double lambda = (b.stress[1][1] - b.stress[1][0]) / STRAIN;
  return (M - lambda) * (M + 2.0 * lambda) / (M + lambda);
}

std::optional<PhaseFieldCracks> ComposedMaterial::phase_field_cracks() const
{
  if (!damage || strcmp(damage->info->name, DamagePhaseField::name) != 0) return {};
  const LawParameters &p = damage->parameters;
  const PhaseField field = DamagePhaseField::field(p);
  const auto is_length = [](const ParameterPlace &place) {
    return place.term < 0 && place.parameter == DamagePhaseField::LENGTH;
  };
  PhaseFieldCracks cracks = {};
  cracks.length = p.value[DamagePhaseField::LENGTH];
  cracks.xi = field.xi;
  cracks.c0 = field.c0;
  cracks.energy = p.value[DamagePhaseField::GC];
  cracks.strength = p.value[DamagePhaseField::STRENGTH_];
  cracks.modulus = youngs_modulus();
  cracks.varies = std::any_of(damage->random.begin(), damage->random.end(), is_length) ||
      std::any_of(damage->varying.begin(), damage->varying.end(), is_length);
  cracks.phase = damage->history + DamagePhaseField::PHASE;
  cracks.driving = damage->history + DamagePhaseField::DRIVING;
  cracks.toughness = damage->history + DamagePhaseField::TOUGHNESS;
  cracks.shape = cracks.strength > 0.0 ? damage->history + DamagePhaseField::SHAPE : -1;
  return cracks;
}

std::optional<PhaseFieldCracks> MPM_NS::phase_field_cracks(const Material &material)
{
  return static_cast<const ComposedMaterial &>(material).phase_field_cracks();
}
