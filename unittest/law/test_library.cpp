// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit physics

// The library of materials as a whole: each law is in the lists of the tests that all laws must
// pass and of the benchmark, depends on no units, and stands fast and large motions; each material
// file tells what it is, where its values come from, and where they are valid.

#include "declare/table_testing.h"
#include "law/law.h"
#include "material/material_testing.h"

#include <cstdlib>
#include <filesystem>
#include <regex>

using namespace MPM_NS;
using namespace material_testing;
using MPM_TEST::text_of_file;

const char *const PART_NAME[NPARTS] = {"", "eos", "strength", "viscosity", "damage", "thermal"};

/** Adds "part name" of all laws that a definition uses; a closed law comes third, after density. */
void collect(const std::string &definition, std::set<std::string> &used)
{
  const auto words = words_of(definition);
  bool composed = false;
  for (size_t k = 0; k + 1 < words.size(); k++)
    for (int part = EOS; part < NPARTS; part++)
      if (words[k] == PART_NAME[part]) {
        used.insert(words[k] + " " + words[k + 1]);
        composed = composed || part == EOS;
      }
  if (!composed && words.size() > 2) used.insert(" " + words[2]);
}

void expect_all(const std::set<std::string> &used, const std::string &where)
{
  for (int part = 0; part < NPARTS; part++)
    for (const auto &info : declared_laws(static_cast<Part>(part)))
      EXPECT_TRUE(used.count(std::string(PART_NAME[part]) + " " + info.name))
          << PART_NAME[part] << " " << info.name << " is not in " << where;
}

/** The material files. */
std::vector<std::filesystem::path> material_files()
{
  std::vector<std::filesystem::path> files;
  for (const auto &entry :
       std::filesystem::directory_iterator(std::string(MPM_SOURCE_DIR) + "/potentials"))
    if (entry.path().extension() == ".mpm") files.push_back(entry.path());
  return files;
}

TEST(Library, AllLawsAreTested)
{
  std::set<std::string> used;
  for (const auto &sample : samples) collect(sample.text, used);
  expect_all(used, "the samples of material/material_testing.h");
}

TEST(Library, AllLawsAreTimed)
{
  // definitions are strings that begin with the density, and may go on over several lines
  const std::string source =
      text_of_file(std::string(MPM_SOURCE_DIR) + "/bench/bench_materials.cpp");
  std::set<std::string> used;
  for (size_t at = source.find("\"density "); at != std::string::npos;
       at = source.find("\"density ", at + 1)) {
    const std::string entry = source.substr(at, source.find('}', at) - at);
    std::string text;
    bool inside = false;
    for (const char c : entry)
      if (c == '"')
        inside = !inside;
      else if (inside)
        text += c;
    collect(text, used);
  }
  expect_all(used, "bench_materials.cpp");
}

TEST(Library, MaterialFilesAreComplete)
{
  std::set<std::string> names;
  for (const auto &path : material_files()) {
    const std::string name = path.stem().string(), text = text_of_file(path);
    SCOPED_TRACE(name);
    names.insert(name);
    const std::string header = text.substr(0, text.find('\n'));
    for (const char *key : {"DATE: 20", "UNITS: si", "CITATION: ", "COMMENT: "})
      EXPECT_NE(header.find(key), std::string::npos) << key;
    for (const char c : text) ASSERT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << "not ASCII";

    const auto material = make(definition(name));
    EXPECT_FALSE(material->ranges().empty()) << "no range of validity";
    MaterialPoint p(*material);
    const double c = p.wave_speed();
    EXPECT_TRUE(std::isfinite(c) && c > 1.0 && c < 2e4) << c;
    move_to(p, {1.0 - 1e-4, 1e-4, 0, 0, 1, 0, 0, 0, 1}, 1e-6);
    EXPECT_TRUE(std::isfinite(size(stress_of(p))));
  }
  for (const auto &name : words_of(
           "Cu_OFHC_JC Al_1100_O_SCG Al_2024_T351_JC Al_6061_T6_JC Al_7075_T651_JC Steel_4340_JC "
           "Steel_1006_JC Weldox_460E_JC Iron_Armco_JC W_alloy_JC Ti_6Al4V_JC Ta_SCG Water_Tait "
           "Water_shock Air Glycerol TNT_JWL CompB_JWL PBX9404_JWL Rubber_Treloar_Ogden "
           "PMMA_elastic Ice Snow_Stomakhin Sand_dry_DP Sand_Toyoura_wet_DP Gelatin_10_ballistic "
           "Clay_London_CC Concrete_C30_MC Sandstone_Berea_MC"))
    EXPECT_TRUE(names.count(name)) << name;
}

// where a file says that its moduli come from E and nu, they do, to the digits that it has; the
// bulk modulus of a shock equation of state has sources of its own
TEST(Library, ModuliAreThoseOfEAndNu)
{
  const std::regex words("E = ([0-9.]+) ([GM])Pa, nu = ([0-9]\\.[0-9]+)"), shock("\\neos +shock ");
  int files = 0;
  for (const auto &path : material_files()) {
    const std::string name = path.stem().string(), text = text_of_file(path);
    std::smatch found;
    if (!std::regex_search(text, found, words) || text.find("\nstrength") == std::string::npos)
      continue;
    SCOPED_TRACE(name);
    files++;
    const double E = std::stod(found[1]) * (found[2] == "G" ? GPa : MPa), nu = std::stod(found[3]);
    const double e = 1e-7;
    Point sheared(definition(name)), pressed(definition(name));
    move_to(sheared, {1, e, 0, 0, 1, 0, 0, 0, 1});
    EXPECT_NEAR(sheared.stress(3) / e / (0.5 * E / (1 + nu)), 1.0, 5e-3);
    if (std::regex_search(text, shock)) continue;
    move_to(pressed, isotropic(1 - e));
    EXPECT_NEAR(pressed.pressure() / (3 * e) / (E / (3 * (1 - 2 * nu))), 1.0, 6e-4);
  }
  EXPECT_GE(files, 14);
}

// longitudinal speeds of sound, as handbooks and tables for ultrasonic testing have them (such as
// the CRC Handbook of Chemistry and Physics): density, bulk and shear modulus of the files come
// from tests at high rates, and must be those of the material all the same. (Not so in
// PMMA_elastic, with a slow modulus, and in Water_shock, a line for strong shocks.)
TEST(Library, SpeedsOfSoundAreThoseOfHandbooks)
{
  const std::pair<double, const char *> tables[] = {
      {0.02,
       "Cu_OFHC_JC 4760 Cu_OFHC_SCG 4760 Cu_OFHC_ZA 4760 Al_1100_O_SCG 6420 Al_2024_T351_JC 6370 "
       "Al_6061_T6_JC 6400 Al_6061_T6_SCG 6400 Al_7075_T651_JC 6350 Steel_1006_JC 5960 "
       "Steel_4340_JC 5850 Iron_Armco_JC 5950 Iron_Armco_ZA 5950 W_alloy_JC 5220 W_alloy_SCG 5180 "
       "Ti_6Al4V_JC 6130 Ta_SCG 4160 Water_Tait 1482 Glycerol 1920 Air 340"},
      // where alloys, glasses, ices, or strong shocks differ
      {0.05, "Weldox_460E_JC 5960 Ice_polycrystal 3980 Glass_soda_lime 5840 Hg_shock 1450"}};
  for (const auto &[tolerance, table] : tables) {
    std::istringstream in(table);
    std::string name;
    for (double speed; in >> name >> speed;)
      EXPECT_NEAR(Point(definition(name)).wave_speed() / speed, 1.0, tolerance) << name;
  }
}

// wet sand, gelatin, the failure of Weldox: laws make of the values what the sources say
TEST(Library, WetSandIsAtCriticalState)
{
  Point p(definition("Sand_Toyoura_wet_DP"));
  // density of saturated sand from void ratio 0.915, grains of 2650, water of 1000
  EXPECT_NEAR(p.density(), (2650 + 0.915 * 1000) / 1.915, 1.0);
  const double G = 125 * 1e5 * std::pow(2.97 - 0.915, 2) / 1.915;
  const double K = 2 * G * 1.05 / (3 * 0.9);
  EXPECT_NEAR(p.wave_speed(), std::sqrt((K + 4 * G / 3) / p.density()), 4e-4 * p.wave_speed());
  // squeezed to about 100 kPa, then triaxial compression at constant volume: q = 1.25 p
  move_to(p, isotropic(0.9987));
  const double pressure = p.pressure();
  EXPECT_NEAR(pressure, 1e5, 3e4);
  for (int i = 1; i <= 100; i++) {
    const double a = 0.9987 * std::exp(-0.001 * i), b = 0.9987 * std::exp(0.0005 * i);
    move_to(p, diagonal(a, b, b));
  }
  EXPECT_NEAR(p.vonmises() / p.pressure(), 1.25, 1e-4);
  EXPECT_NEAR(p.pressure(), pressure, 1e-12 * pressure);
}

TEST(Library, GelatinFollowsItsHugoniot)
{
  const auto material = make(definition("Gelatin_10_ballistic"));
  for (const double eta : {0.02, 0.05, 0.1}) {
    MaterialPoint p(*material);
    move_to(p, uniaxial_stretch(1 - eta), 1e-6);
    const double us = 1520 / (1 - 2.0 * eta), up = eta * us;
    EXPECT_NEAR(p.pressure(), 1030 * us * up, 0.02 * p.pressure()) << eta;
  }
  MaterialPoint p(*material);
  EXPECT_NEAR(p.wave_speed(), 1520, 2);
  // shear: yields at 0.22 MPa, fails at the plastic strain 0.9
  double failed = 0.0;
  for (int i = 1; i <= 200 && !failed; i++) {
    move_to(p, {1, 0.01 * i, 0, 0, 1, 0, 0, 0, 1});
    if (value(p, "damage") >= 1.0) failed = 0.01 * i;
    if (i > 60 && !failed) EXPECT_NEAR(p.vonmises(), 0.22e6, 1e-6);
  }
  // at a shear of sqrt(3) in steps of 0.01, with some of the elastic shear lost as it turns
  EXPECT_NEAR(failed, std::sqrt(3.0) * (0.9 + 0.22e6 / (3 * 0.85e6)), 0.03);
  EXPECT_EQ(p.vonmises(), 0.0);
}

TEST(Library, WeldoxFailsAtTheStrainsOfItsTests)
{
  const auto material = make(definition("Weldox_460E_failure"));
  // uniaxial stress: triaxiality 1/3; simple shear: 0
  for (const bool shear : {false, true}) {
    MaterialPoint p(*material);
    if (shear) {
      for (int i = 1; i < 10000 && value(p, "damage") < 1.0; i++)
        move_to(p, {1, 1e-3 * i, 0, 0, 1, 0, 0, 0, 1});
    } else {
      double lateral = 1.0;
      for (int i = 1; i < 10000 && value(p, "damage") < 1.0; i++) {
        const double axial = std::exp(2e-4 * i);
        double low = lateral * 0.9997, high = lateral * 1.0001;
        const MaterialPoint before(p);
        for (int k = 0; k < 50; k++) {
          lateral = 0.5 * (low + high);
          MaterialPoint trial(before);
          move_to(trial, diagonal(axial, lateral, lateral));
          (trial.stress(1) > 0.0 ? high : low) = lateral;
          if (value(trial, "damage") >= 1.0) break;
        }
        move_to(p, diagonal(axial, lateral, lateral));
      }
    }
    EXPECT_NEAR(value(p, "eplastic"), shear ? 0.636 + 1.936 : 1.355612, 5e-4) << shear;
  }
}

/* ---------------------------------------------------------------------- units */

/** Numbers in other units over those in SI. */
struct Scales {
  const char *style;
  double pressure, length, velocity, density, energy, temperature;
  double time() const { return length / velocity; }
  double mass() const { return density * length * length * length; }

  /** n: exponent of laws with units of pressure time^N */
  double of(const std::string &unit, double n) const
  {
    const double volume = length * length * length;
    const std::map<std::string, double> known = {
        {"1", 1.0},
        {"degrees", 1.0},
        {"pressure", pressure},
        {"1/pressure", 1.0 / pressure},
        {"temperature", temperature},
        {"1/temperature", 1.0 / temperature},
        {"time", time()},
        {"1/time", 1.0 / time()},
        {"length", length},
        {"volume", volume},
        {"1/volume", 1.0 / volume},
        {"velocity", velocity},
        {"pressure time", pressure * time()},
        {"pressure time^N", pressure * std::pow(time(), n)},
        {"pressure*length", pressure * length},
        {"energy/mass", energy / mass()},
        {"energy/(mass temperature)", energy / mass() / temperature},
        {"energy/(time length temperature)", energy / time() / length / temperature}};
    const auto found = known.find(unit);
    if (found == known.end()) {
      ADD_FAILURE() << "unknown unit " << unit;
      return 1.0;
    }
    return found->second;
  }
};

const Scales UNIT_STYLES[] = {{"real", 1 / 101325.0, 1e10, 1e-5, 1e-3, 1 / 6947.7e-24, 1.0},
                              {"metal", 1e-5, 1e10, 1e-2, 1e-3, 1 / 1.602176634e-19, 1.0},
                              {"cgs", 10.0, 100.0, 100.0, 1e-3, 1e7, 1.0},
                              {"micro", 1e-3, 1e6, 1.0, 1e-3, 1e9, 1.0},
                              {"nano", 1e-6, 1e9, 1.0, 1e-6, 1e21, 1.0},
                              {"lj", 1.3e-9, 0.7, 0.011, 1.9e-4, 3.1e-6, 0.01},
                              {"stiff", 1e6, 1e-3, 1e3, 1.0, 1.0, 1.0}};

bool is_number(const std::string &word)
{
  char *end;
  std::strtod(word.c_str(), &end);
  return end != word.c_str() && !*end;
}

/** Walks through a definition; change() gets each number with its declaration. */
std::string changed(const std::string &definition,
                    const std::function<double(double, const Parameter &, double n)> &change)
{
  static const Parameter DENSITY = {"", "RHO", "density", POSITIVE, REQUIRED, ""};
  const auto words = words_of(definition);
  std::string result;
  size_t k = 0;
  double n = 1.0;
  const auto copy = [&]() {
    result += words[k++] + " ";
  };
  const auto numbers = [&](const Parameter *p, int np, const std::string &option) {
    for (int i = 0; i < np; i++) {
      if (p[i].option != option || strcmp(p[i].unit, FLAG) == 0) continue;
      if (k == words.size() || !is_number(words[k])) return;
      result += joined(change(std::stod(words[k++]), p[i], n), " ");
    }
  };
  while (k < words.size()) {
    if (words[k] == "density") {
      copy();
      numbers(&DENSITY, 1, "");
      continue;
    }
    int part = CLOSED;
    for (int i = EOS; i < NPARTS; i++)
      if (words[k] == PART_NAME[i]) part = i;
    if (part != CLOSED) copy();
    const LawInfo *info = nullptr;
    for (const auto &law : declared_laws(static_cast<Part>(part)))
      if (words[k] == law.name) info = &law;
    if (!info) throw std::runtime_error("unknown law " + words[k]);
    copy();
    int at = 0;
    for (int i = 0; i < info->nparameters; i++)
      if (!*info->parameters[i].option && k + at < words.size()) {
        if (std::string(info->parameters[i].name) == "N" && is_number(words[k + at]))
          n = std::stod(words[k + at]);
        at++;
      }
    numbers(info->parameters, info->nparameters, "");
    for (bool more = true; more && k < words.size();) {
      more = false;
      if (info->term && words[k] == info->term) {
        copy();
        for (int i = 0; i < info->nterm_parameters; i++) {
          Parameter p = info->term_parameters[i];
          p.option = "";
          numbers(&p, 1, "");
        }
        more = true;
        continue;
      }
      std::string option;    // the longest that is here
      for (int i = 0; i < info->nparameters; i++) {
        const auto own = words_of(info->parameters[i].option);
        bool here = !own.empty() && k + own.size() <= words.size();
        for (size_t j = 0; here && j < own.size(); j++) here = words[k + j] == own[j];
        if (here && strlen(info->parameters[i].option) > option.size())
          option = info->parameters[i].option;
      }
      if (option.empty()) continue;
      for (size_t j = words_of(option).size(); j > 0; j--) copy();
      numbers(info->parameters, info->nparameters, option);
      more = true;
    }
  }
  return result;
}

/** Response to a motion with compression, shear, and rotation, in SI units. */
std::vector<double> response(const Material &material, const Scales &s)
{
  MaterialPoint p(material, 1, 0.1 * s.length);
  p.batch.vol0[0] = s.length * s.length * s.length;
  std::vector<double> all;
  for (int i = 0; i < 40; i++) {
    const double x = 0.15 * i, e = 0.004;
    moves(p, {-e * std::cos(x), e, 0, -0.5 * e, e * std::sin(x), 0.3 * e, 0, 0, 0.1 * e},
          1e-4 * s.time());
    for (int k = 0; k < 6; k++) all.push_back(p.stress(k) / s.pressure);
    all.push_back(p.stored_energy() / s.pressure);
    all.push_back(p.wave_speed() / s.velocity);
  }
  return all;
}

TEST(Library, LawsHaveNoUnitsOfTheirOwn)
{
  const Scales si = {"si", 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  for (const auto &sample : samples) {
    SCOPED_TRACE(sample.name);
    const auto expected = response(*make(sample.text), si);
    double scale[8] = {};
    for (size_t k = 0; k < expected.size(); k++)
      scale[k % 8 < 6 ? 0 : k % 8] = std::max(scale[k % 8 < 6 ? 0 : k % 8], std::fabs(expected[k]));
    for (const auto &units : UNIT_STYLES) {
      SCOPED_TRACE(units.style);
      const auto material = make(changed(sample.text, [&](double x, const Parameter &p, double n) {
        return x * (std::string(p.unit) == "density" ? units.density : units.of(p.unit, n));
      }));
      const double volume = std::pow(units.length, 3);
      ASSERT_TRUE(material->configure(
          nullptr, units.pressure / (units.density * units.velocity * units.velocity),
          units.pressure * volume / units.energy));
      const auto found = response(*material, units);
      for (size_t k = 0; k < expected.size(); k++)
        ASSERT_NEAR(found[k], expected[k], 1e-7 * scale[k % 8 < 6 ? 0 : k % 8] + 1e-200)
            << "step " << k / 8 << " value " << k % 8;
    }
  }
}

/** Rates of strain, steps, volumes, and temperatures far from those of any test of the material. */
void stand_extremes(const Material &material)
{
  for (const double rate : {1e-6, 1.0, 1e4, 1e8})
    for (const double e : {1e-6, 1e-3, 0.1, 1.0}) {
      MaterialPoint p(material);
      for (int i = 0; i < 12; i++) {
        const double c = i % 3 == 0 ? -0.6 * e : 0.9 * e;
        moves(p, {c, i % 2 ? e : -e, 0, 0, 0, 0, 0, 0, i % 4 ? 0.0 : -0.3 * e}, e / rate);
      }
      SCOPED_TRACE(joined("rate ", rate));
      expect_finite(p);
    }
  for (const double J : {0.2, 50.0})
    for (const int n : {1, 7, 300}) {
      MaterialPoint p(material);
      moves(p, isotropic(std::cbrt(std::pow(J, 1.0 / n)) - 1.0), 1e-3, n);
      SCOPED_TRACE(joined("J ", J));
      expect_finite(p);
    }
  for (size_t k = 0; k < material.history().size(); k++)
    if (material.history()[k].name == "temperature")
      for (const double T : {0.0, 1e-3, 1000.0, 3000.0, 1e5}) {
        MaterialPoint p(material);
        p.batch.history[k][0] = T;
        moves(p, {-0.01, 0.02, 0, 0, 0, 0, 0, 0, 0.003}, 1e-6, 20);
        SCOPED_TRACE(joined("temperature ", T));
        expect_finite(p);
      }
}

TEST(Library, LawsStandExtremes)
{
  for (const auto &sample : samples) {
    SCOPED_TRACE(sample.name);
    stand_extremes(*make(sample.text));
    // nearly incompressible, soft as foam and stiff as diamond
    for (const double stiffness : {1.0, 1e-6, 1e6}) {
      SCOPED_TRACE(stiffness);
      const std::string text = changed(sample.text, [&](double x, const Parameter &p, double) {
        const std::string unit = p.unit;
        if (std::string(p.name) == "NU") return 0.4999;
        return unit == "pressure" || unit == "pressure time" || unit == "pressure*length"
            ? x * stiffness
            : unit == "1/pressure" ? x / stiffness
                                   : x;
      });
      std::unique_ptr<Material> material;
      try {
        material = make(text);
      } catch (const MaterialError &) {    // refused with a reason
        continue;
      }
      stand_extremes(*material);
    }
  }
}
