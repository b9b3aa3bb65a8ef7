/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/random_field.h"

#include "math/random.h"

#include <cmath>

#ifdef MPM_FFTW
#include <fftw3.h>
#endif

using namespace MPM_NS;

static constexpr double PI = 3.14159265358979323846;
static constexpr double LARGEST = 0x1p50;    // number of a cell in which there still are places

#ifdef MPM_FFTW

/** Arrays and plans for the window of a tile, and the spectrum of the filter along an axis: the
 *  filter is a product, as correlation and splines are. */
struct RandomField::Transforms {
  static constexpr int HALF = WINDOW / 2 + 1;
  double *real;
  fftw_complex *complex;
  fftw_plan forward, backward;
  double filter[WINDOW];

  Transforms()
  {
    real = fftw_alloc_real(WINDOW * WINDOW * WINDOW);
    complex = fftw_alloc_complex(WINDOW * WINDOW * HALF);
    // FFTW_ESTIMATE: the plan, and so the rounding, does not depend on a measurement
    forward = fftw_plan_dft_r2c_3d(WINDOW, WINDOW, WINDOW, real, complex, FFTW_ESTIMATE);
    backward = fftw_plan_dft_c2r_3d(WINDOW, WINDOW, WINDOW, complex, real, FFTW_ESTIMATE);
    const double pl = PER_LENGTH;
    for (int n = 0; n < WINDOW; n++) {
      const double angle = 2.0 * PI * (n <= WINDOW / 2 ? n : n - WINDOW) / WINDOW;
      // spectrum of exp(-r^2/length^2) per node: sqrt(pi) pl exp(-(angle pl)^2/4), its root;
      // spline: (4 + 2 cos)/6 from its values at the nodes
      const double root =
          std::sqrt(std::sqrt(PI) * pl) * std::exp(-0.125 * angle * angle * pl * pl);
      filter[n] = root * 3.0 / (2.0 + std::cos(angle)) / WINDOW;
    }
  }
  ~Transforms()
  {
    fftw_destroy_plan(forward);
    fftw_destroy_plan(backward);
    fftw_free(real);
    fftw_free(complex);
  }
};

/** Coefficients of the splines with support in a tile. */
std::vector<double> RandomField::make_tile(const Index &tile) const
{
  const Transforms &t = *transforms;
  const Index first = {TILE * tile[0] - MARGIN, TILE * tile[1] - MARGIN, TILE * tile[2] - MARGIN};
  double *real = t.real;
  for (int i = 0; i < WINDOW; i++)
    for (int j = 0; j < WINDOW; j++)
      for (int k = 0; k < WINDOW; k += 2, real += 2)
        noise(first[0] + i, first[1] + j, first[2] + k, real);
  fftw_execute(t.forward);
  fftw_complex *c = t.complex;
  for (int i = 0; i < WINDOW; i++)
    for (int j = 0; j < WINDOW; j++)
      for (int k = 0; k < Transforms::HALF; k++, c++) {
        const double f = t.filter[i] * t.filter[j] * t.filter[k];
        (*c)[0] *= f;
        (*c)[1] *= f;
      }
  fftw_execute(t.backward);
  std::vector<double> kept;
  kept.reserve(KEPT * KEPT * KEPT);
  for (int i = 0; i < KEPT; i++)
    for (int j = 0; j < KEPT; j++)
      for (int k = 0; k < KEPT; k++)
        kept.push_back(
            t.real[((MARGIN - 1 + i) * WINDOW + MARGIN - 1 + j) * WINDOW + MARGIN - 1 + k]);
  return kept;
}

#else

struct RandomField::Transforms {
  Transforms() { throw std::runtime_error("no random fields without FFTW"); }
};

std::vector<double> RandomField::make_tile(const Index &) const
{
  return {};
}

#endif

bool RandomField::available()
{
#ifdef MPM_FFTW
  return true;
#else
  return false;
#endif
}

RandomField::RandomField(double length, uint64_t seed) :
    spacing(length / PER_LENGTH), seed(seed), transforms(new Transforms)
{
}

RandomField::~RandomField() = default;

/** Normal deviates of the nodes (i,j,k) and (i,j,k+1), k even (G.E.P. Box, M.E. Muller, Ann.
 *  Math. Stat. 29 (1958) 610), from two hashes of the indices. */
void RandomField::noise(int64_t i, int64_t j, int64_t k, double *pair) const
{
  uint64_t h = mix_bits(seed + RANDOM_STEP);
  for (const int64_t n : {i, j, k}) h = mix_bits(h + RANDOM_STEP + static_cast<uint64_t>(n));
  const double u = ((mix_bits(h + RANDOM_STEP) >> 11) + 0.5) * 0x1p-53;
  const double v = (mix_bits(h + 2 * RANDOM_STEP) >> 11) * 0x1p-53;
  const double radius = std::sqrt(-2.0 * std::log(u));
  pair[0] = radius * std::cos(2.0 * PI * v);
  pair[1] = radius * std::sin(2.0 * PI * v);
}

double RandomField::value(const double *x) const
{
  Index tile;
  int first[3];
  double w[3][4];
  for (int d = 0; d < 3; d++) {
    const double s = x[d] / spacing, cell = std::floor(s), t = s - cell;
    if (!(std::fabs(s) < LARGEST))
      throw std::runtime_error("random: the correlation length is too short for the coordinates of "
                               "a point");
    tile[d] = static_cast<int64_t>(std::floor(cell / TILE));
    first[d] = static_cast<int>(static_cast<int64_t>(cell) - TILE * tile[d]);
    w[d][0] = (1.0 - t) * (1.0 - t) * (1.0 - t) / 6.0;
    w[d][1] = (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
    w[d][3] = t * t * t / 6.0;
    w[d][2] = 1.0 - w[d][0] - w[d][1] - w[d][3];
  }
  auto found = tiles.find(tile);
  nvalues++;
  if (found == tiles.end()) {
    if (ntiles++ >= TILES_TO_TRY && nvalues < LEAST_VALUES * ntiles)
      throw std::runtime_error("random: the correlation length is too short: with a fifth of the "
                               "distance of points, their values are independent already");
    if (tiles.size() >= MAX_TILES) tiles.clear();
    found = tiles.emplace(tile, make_tile(tile)).first;
  }
  const double *c = found->second.data();
  double sum = 0.0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const double *row = c + ((first[0] + i) * KEPT + first[1] + j) * KEPT + first[2];
      sum += w[0][i] * w[1][j] *
          (w[2][0] * row[0] + w[2][1] * row[1] + w[2][2] * row[2] + w[2][3] * row[3]);
    }
  return sum;
}
