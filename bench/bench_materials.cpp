/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Cost of the constitutive laws: time per point of Material::update (yielding points, or
// *_elastic), wave_speed and stored_energy on full batches, for each instruction set that this CPU
// has.

#include "material/material_point.h"
#include "math/matrix.h"
#include "transfer/kernels.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <random>
#include <sstream>

using namespace MPM_NS;

namespace {

struct Sample {
  const char *name, *text;
} samples[] = {
    {"linear", "density 1000 linear 1e9 0.3"},
    {"neohookean", "density 1000 neohookean 1e9 0.3"},
    {"neohookean_split", "density 1000 neohookean/split 1e9 0.3"},
    {"corotated", "density 1000 corotated 1e9 0.3"},
    {"stvenant_kirchhoff", "density 1000 stvenant/kirchhoff 1e9 0.3"},
    {"hencky", "density 1000 hencky 1e9 0.3"},
    {"mooney_rivlin", "density 1000 mooney/rivlin 0.3e6 0.1e6 2e6"},
    {"ogden3", "density 1000 ogden 2e6 term 0.63e6 1.3 term 0.0012e6 5 term -0.01e6 -2"},
    {"transversely_isotropic",
     "density 1580 transversely/isotropic 126e9 11e9 0.28 0.4 6.6e9 axis 1 2 -0.5"},
    {"orthotropic",
     "density 600 orthotropic 11e9 0.9e9 0.5e9 0.4 0.45 0.5 0.7e9 0.65e9 0.05e9 "
     "axes 1 2 0 0 1 1 angle 20"},
    {"woven", "density 800 woven 2e8 1e8 5e6 angle 80 locking 40 2e7"},
    {"linear_newtonian", "density 1000 linear 1e9 0.3 viscosity newtonian 10"},
    {"neohookean_maxwell1", "density 1000 neohookean 1e9 0.3 viscosity maxwell term 1e9 1e-3"},
    {"neohookean_maxwell3",
     "density 1000 neohookean 1e9 0.3 viscosity maxwell term 1e9 1e-3 term 1e9 1e-2 term 1e9 1e-1"},
    {"elastic", "density 2700 eos linear 70e9 strength elastic 26e9"},
    {"j2", "density 8930 eos linear 1e11 strength j2 43e9 157e6 hardening linear 425e6"},
    {"j2_adiabatic",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 hardening linear 425e6 "
     "thermal adiabatic 385 300 0.9"},
    {"j2_gruneisen",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 hardening linear 425e6 "
     "thermal adiabatic 385 300 0.9 gruneisen 2"},
    {"j2_conducting",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 hardening linear 425e6 "
     "thermal conducting 385 300 400 0.9"},
    {"j2_shock",
     "density 8930 eos shock 3940 1.49 1.96 strength j2 43e9 157e6 hardening linear 425e6"},
    {"j2_power", "density 8940 eos linear 1e11 strength j2 44e9 65e6 hardening power 356e6 0.37"},
    {"j2_voce", "density 8940 eos linear 1e11 strength j2 44e9 65e6 hardening voce 2e8 15 1e8"},
    {"j2_table",
     "density 8940 eos linear 1e11 strength j2 44e9 65e6 point 0.01 1e8 point 0.1 2e8 point 1 4e8"},
    {"j2_kinematic",
     "density 8940 eos linear 1e11 strength j2 44e9 65e6 hardening linear 1e8 kinematic 2e10 100"},
    {"j2_cowper_symonds",
     "density 8940 eos linear 1e11 strength j2 44e9 65e6 hardening power 356e6 0.37 "
     "rate cowper/symonds 40 5"},
    {"johnson_cook",
     "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 0.168 "
     "0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9"},
    {"johnson_cook_warm",
     "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 0.168 "
     "0.0089 1 1.1 1540 20 thermal constant 600"},
    {"johnson_cook_cold",
     "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 "
     "0.168 0.0089 1"},
    {"zerilli_armstrong_bcc",
     "density 7870 eos linear 165e9 strength zerilli/armstrong 80e9 65e6 form bcc 1033e6 0.00698 "
     "0.000415 266e6 0.289 thermal adiabatic 450 300 0.9"},
    {"zerilli_armstrong_fcc",
     "density 8930 eos linear 137e9 strength zerilli/armstrong 47e9 65e6 form fcc 890e6 0.0028 "
     "0.000115 melt 1356 thermal adiabatic 385 300 0.9"},
    {"steinberg",
     "density 8930 eos linear 137e9 strength steinberg 47.7e9 0.12e9 36 0.45 0.64e9 2.83e-11 "
     "3.77e-4 melt 1790 1.5 2.02 thermal adiabatic 385 300 0.9 gruneisen 2.02"},
    {"gurson",
     "density 7800 gurson 200e9 0.3 400e6 0.02 hardening 0.01 0.1 nucleation 0.04 0.1 0.05 "
     "coalescence 0.15 0.25"},
    {"gurson_elastic",
     "density 7800 gurson 200e9 0.3 400e12 0.02 hardening 1e6 0.1 nucleation 0.04 0.1 0.05 "
     "coalescence 0.15 0.25"},
    {"johnson_cook_damage",
     "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 0.168 0.0089 1 1.1 "
     "1540 20 thermal adiabatic 460 20 0.9 damage johnson/cook 0.05 3.44 -2.12 rate 0.002 1 "
     "temperature 0.61 1540 20 soften from 0"},
    {"cockcroft_latham",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 hardening linear 425e6 "
     "damage cockcroft/latham 1e9"},
    {"rankine", "density 2700 eos linear 70e9 strength elastic 26e9 damage rankine 1e9"},
    {"rankine_weibull",
     "density 2700 eos linear 70e9 strength elastic 26e9 "
     "damage rankine 1e9 soften energy 1e6 weibull 8 1 1"},
    {"grady_kipp",
     "density 2700 eos linear 70e9 strength elastic 26e9 damage grady/kipp 1e20 8 1000 7e10"},
    {"phasefield",
     "density 2700 eos linear 70e9 strength elastic 26e9 "
     "damage phasefield 1e6 1.0 model cohesive 1e9"},
    {"tait", "density 1000 eos tait 2.2e9 7"},
    {"water", "density 1000 eos tait 2.2e9 7 cutoff -1e5 viscosity newtonian 1e-3"},
    {"drucker_prager", "density 1600 drucker/prager 1e8 0.3 30 dilatancy 5"},
    {"mohr_coulomb", "density 1900 mohr/coulomb 1e8 0.3 30 1e4 dilatancy 10"},
    {"mohr_coulomb_soft", "density 1900 mohr/coulomb 1e8 0.3 30 3e4 residual 1e4 20 5"},
    {"mohr_coulomb_elastic", "density 1900 mohr/coulomb 1e8 0.3 30 1e12 dilatancy 10"},
    {"mohr_coulomb_soft_elastic", "density 1900 mohr/coulomb 1e8 0.3 30 1e12 residual 1e4 20 5"},
    {"mui", "density 1500 mui 1e8 0.3 0.38 0.64 0.3 1e-3"},
    {"camclay", "density 1900 camclay 5e6 0.9 0.2 0.04 0 1e5 1.5e5"},
    {"nacc", "density 250 nacc 1e6 0.3 1.85 0.3 3 -0.05"},
    {"snow", "density 400 snow 1.4e5 0.2 0.025 0.0075 5"},
    {"snow_elastic", "density 400 snow 1.4e5 0.2 0.9 0.9 5"},
    {"artificial", "density 1000 eos linear 1e9 viscosity artificial 1.5 0.06"},
    {"eos_linear", "density 1000 eos linear 1e9"},
    {"eos_shock", "density 8930 eos shock 3940 1.49 1.96"},
    {"eos_shock_spall", "density 8930 eos shock 3940 1.49 1.96 spall -1e9"},
    {"polynomial", "density 2700 eos polynomial 7e10 8e10 5e10 2 1.5"},
    {"ideal_gas", "density 1.2 eos ideal/gas 1.4 pressure 1e5"},
    {"stiffened_gas", "density 1000 eos stiffened/gas 4.4 6e8 pressure 1e5"},
    {"jwl", "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930 detonate 0 0 0 0"},
    {"newtonian", "density 1000 eos linear 1e9 viscosity newtonian 1 bulk 1"},
    {"bingham", "density 1000 eos linear 1e9 viscosity bingham 1 20 1e3"},
    {"herschel_bulkley", "density 1000 eos linear 1e9 viscosity herschel/bulkley 1 0.5 20 1e3"},
    {"power", "density 1000 eos linear 1e9 viscosity power 1 0.5 0.01 1e3"},
};

enum Task { UPDATE, SPEED, ENERGY };

/** Points in motion: yielding in most laws, all different. */
void run(benchmark::State &state, const char *text, const char *isa, Task task)
{
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  const auto material = Material::create(words, isa);

  MaterialPoint p(*material, BATCH, 1e-3);
  Batch &b = p.batch;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  b.dt = 1e-7;
  for (int step = 0; step < 50; step++) {
    for (int i = 0; i < BATCH; i++) {
      double F[9];
      for (int k = 0; k < 9; k++) {
        // compression and shear, with a part that differs from point to point
        b.A[k][i] = 1e-3 * ((k == 0 ? -0.3 : k == 1 ? 1.0 : 0.0) + 0.2 * normal(random));
        F[k] = b.F[k][i];
      }
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
          for (int k = 0; k < 3; k++) b.F[3 * r + c][i] += b.A[3 * r + k][i] * F[3 * k + c];
      for (int k = 0; k < 9; k++) F[k] = b.F[k][i];
      b.Jold[i] = b.J[i];
      b.J[i] = determinant(F);
    }
    if (step < 49) material->update(b);
  }

  alignas(64) double stress[6][BATCH], out[BATCH];
  memcpy(stress, b.stress, sizeof(stress));
  const std::vector<double> history = p.storage;
  for (auto _ : state) {
    if (task == UPDATE) {
      memcpy(b.stress, stress, sizeof(stress));
      if (!history.empty()) memcpy(b.history, history.data(), history.size() * sizeof(double));
      material->update(b);
      benchmark::DoNotOptimize(b.stress[0][0]);
    } else if (task == SPEED)
      material->wave_speed(b, out);
    else
      material->stored_energy(b, out);
    benchmark::ClobberMemory();
  }
  state.counters["per_point"] = benchmark::Counter(
      state.iterations() * BATCH, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}    // namespace

int main(int argc, char **argv)
{
  const char *task_name[] = {"update", "wave_speed", "stored_energy"};
  for (const char *isa : {"baseline", "avx2", "avx512"}) {
    if (!MPMKernels::select(isa)) continue;
    for (const Task task : {UPDATE, SPEED, ENERGY})
      for (const auto &sample : samples) {
        const std::string name = std::string(isa) + "/" + task_name[task] + "/" + sample.name;
        benchmark::RegisterBenchmark(name.c_str(), run, sample.text, isa, task);
      }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
