/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_DECLARE_H
#define MPM_LAW_DECLARE_H

// From the struct of a law to what the package knows of it: its declaration and its kernels.

#include "law/law.h"

namespace MPM_NS::law {
namespace {

  template <class T, int N> constexpr int count(const T (&)[N])
  {
    return N;
  }
  constexpr int count(std::nullptr_t)
  {
    return 0;
  }

  template <class Law> LawInfo declaration()
  {
    LawInfo info;
    info.name = Law::name;
    info.meaning = Law::meaning;
    info.share = Law::share;
    info.parameters = Law::parameters;
    info.nparameters = count(Law::parameters);
    info.term = Law::term;
    info.term_parameters = Law::term_parameters;
    info.nterm_parameters = count(Law::term_parameters);
    info.history = Law::history;
    info.ndeclared = count(Law::history);
    info.term_history = Law::term_history;
    info.nterm_history = count(Law::term_history);
    info.nhistory = Law::nhistory;
    info.uses_speed = Law::uses_speed;
    info.uses_F = Law::uses_F;
    info.check = Law::check;
    info.needs_temperature = Law::needs_temperature;
    info.heat_share = Law::heat_share;
    info.warming = Law::warming;
    info.initialize = Law::initialize;
    static_assert(count(Law::parameters) <= LawParameters::MAX);
    static_assert(count(Law::term_parameters) <= LawParameters::TERM);
    return info;
  }

  template <class Law> constexpr LawKernels kernels()
  {
    return {Law::update, Law::modulus, Law::energy, Law::raise_speed, Law::prepare};
  }

}    // namespace
}    // namespace MPM_NS::law
#endif
