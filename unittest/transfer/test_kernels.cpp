// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit
// timeout: 900

// Transfer kernels of every instruction set: agreement with the reference, and what a transfer must
// do whatever the implementation (conservation, exact fields, rows left alone).

#include "material/batch_kernels.h"
#include "math/matrix.h"
#include "transfer/kernel_testing.h"
#include "transfer/shape.h"

#include <cstdlib>
#include <cstring>
#include <memory>

using namespace MPM_NS;
using namespace MPM_TEST;

/** Points of which the rows [first,last) lie in the tile of a block; arrays are not padded. */
struct Points {
  int dim, order, first, last, n;
  int nC;                                        // reals of a matrix C
  int guarded;                                   // as in PointRows: the last row exists, no more
  bool in_place = true;                          // new positions replace the old ones
  const double *from = nullptr, *P = nullptr;    // as in PointRows
  TransferStep step = random_step();
  int base[3];
  Reals x, v, f, C, tau, vol0, mass, xnew, size;

  Points(int dim, int order, int first, int count, int behind, bool sorted) :
      dim(dim), order(order), first(first), last(first + count), n(first + count + behind),
      nC(dim * dim),
      guarded(integer(0, 1) * (n - 1)), base{integer(-40, 40), integer(-40, 40), integer(-40, 40)},
      x(3 * n), v(3 * n), f(3 * n), C(nC * n), tau(6 * n), vol0(n), mass(n), xnew(3 * n),
      size(3 * n)
  {
    fill(v), fill(f), fill(C), fill(tau);
    for (double &a : vol0) a = uniform(0.5, 1.5) * step.h * step.h * step.h;
    for (double &a : mass) a = uniform(0.5, 1.5);
    for (double &a : size) a = uniform(0.02, 0.5);

    // everywhere in the range of base nodes of a tile
    const double range = block_side(dim) + 2;
    std::vector<std::array<double, 3>> t(n);
    for (auto &a : t)
      for (double &b : a) b = uniform(0.0, range);
    if (sorted)
      std::sort(t.begin(), t.end(), [](const auto &a, const auto &b) {
        for (int i = 0; i < 3; i++)
          if (std::floor(a[i]) != std::floor(b[i])) return a[i] < b[i];
        return a[0] < b[0];
      });
    for (int p = 0; p < n; p++)
      for (int i = 0; i < 3; i++)
        x[3 * p + i] = step.origin[i] + (t[p][i] + 0.5 * (order - 1) + base[i]) * step.h;
    if (dim == 2)
      for (int p = 0; p < n; p++) x[3 * p + 2] = uniform(-1.0, 1.0);
    xnew = x;
  }

  PointRows rows()
  {
    return {x.data(),   v.data(),    f.data(),    C.data(),
            tau.data(), vol0.data(), mass.data(), in_place ? x.data() : xnew.data(),
            nullptr,    guarded,     from,        P,
            size.data()};
  }

  /** Position of a tile node. */
  void node_position(int index, double *position) const
  {
    const int sx = tile_stride_x(dim, order), sy = tile_stride_y(dim, order);
    const int i[3] = {index / sx, dim == 3 ? index % sx / sy : index % sx, index % sx % sy};
    for (int a = 0; a < 3; a++) position[a] = step.origin[a] + (base[a] + i[a]) * step.h;
    if (dim == 2) position[2] = 0.0;
  }
};

/** Tile, 64-byte aligned as in the simulation. */
struct Tile {
  Reals room;
  double *real;
  int nodes, nreal;

  Tile(int dim, int order, int nreal) :
      room(tile_nodes(dim, order) * nreal + 8, 0.0), nodes(tile_nodes(dim, order)), nreal(nreal)
  {
    real = room.data();
    while (reinterpret_cast<size_t>(real) % 64) real++;
  }
  Reals values() const { return Reals(real, real + nodes * nreal); }
  /** One real of all nodes. */
  Reals column(int c) const
  {
    Reals a(nodes);
    for (int n = 0; n < nodes; n++) a[n] = real[nreal * n + c];
    return a;
  }
  double sum(int c) const
  {
    double s = 0.0;
    for (int n = 0; n < nodes; n++) s += real[nreal * n + c];
    return s;
  }
};

/** Component i of a + B x. */
double at(const Reals &a, const Reals &B, const double *x, int i)
{
  return a[i] + B[i] * x[0] + B[3 + i] * x[1] + B[6 + i] * x[2];
}

class Kernels : public KernelTest {
 protected:
  int order;
  bool split;

  void SetUp() override
  {
    KernelTest::SetUp();
    order = stencil_order(GetParam().shape);
    split = nreal == 8;
  }

  Points random_points(int count) const
  {
    return Points(dim, order, integer(0, 3), count, integer(0, 2), integer(0, 1));
  }

  /** Field on the tile's nodes as solve_nodes leaves it: velocity a + B x, old velocity b + D x. */
  Tile linear_field(const Points &points, const Reals &a, const Reals &B, const Reals &b,
                    const Reals &D) const
  {
    Tile tile(dim, order, nreal);
    for (int n = 0; n < tile.nodes; n++) {
      double x[3];
      points.node_position(n, x);
      for (int i = 0; i < 3; i++) {
        tile.real[nreal * n + i] = at(a, B, x, i);
        if (split) tile.real[nreal * n + 4 + i] = at(b, D, x, i);
      }
      tile.real[nreal * n + 3] = 1.0;
    }
    return tile;
  }

  /** Moment about axis k of the vectors from this real of the nodes on, and of their sizes. */
  std::pair<double, double> moment_of_nodes(const Points &points, const Tile &tile, int first,
                                            int k) const
  {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    double moment = 0.0, size = 0.0;
    for (int n = 0; n < tile.nodes; n++) {
      double x[3];
      points.node_position(n, x);
      const double *p = tile.real + nreal * n + first;
      moment += x[i] * p[j] - x[j] * p[i];
      size += std::abs(x[i] * p[j]) + std::abs(x[j] * p[i]);
    }
    return {moment, size};
  }

  Tile random_field() const
  {
    Tile tile(dim, order, nreal);
    fill(tile.room);
    return tile;
  }
};

// Tests of what only some of the combinations have: see the lists at the end.
class ComparedKernels : public Kernels {};
class TotalKernels : public Kernels {};
class AffineKernels : public Kernels {};
class SplitKernels : public Kernels {};
class PlaneKernels : public Kernels {};

// number of points of a run: all small ones, then larger
std::vector<int> counts()
{
  std::vector<int> n = {1, 2, 3, 4, 5, 6, 7, 8, 9, 15, 16, 17, 18, 31, 32, 33, 63, 64, 65};
  for (int i = 0; i < 12; i++) n.push_back(integer(66, 200));
  if (SANITIZED) n = {1, 5, 8, 17, 65, integer(66, 200)};
  return n;
}

/** Sums of a few hundred terms around 1 in another order differ by a few hundred roundings. */
constexpr double SAME = 1.0e-13;

TEST_P(ComparedKernels, P2GAgreesWithReference)
{
  const P2G mine[] = {kernels.p2g, kernels.p2g_momentum, kernels.p2g_force};
  const P2G theirs[] = {reference.p2g, reference.p2g_momentum, reference.p2g_force};
  for (int count : counts())
    for (int which = 0; which < 3; which++) {
      Points points = random_points(count);
      Tile a(dim, order, nreal), b(dim, order, nreal);
      fill(a.room);    // a transfer adds to what is there
      std::memcpy(b.real, a.real, sizeof(double) * a.nodes * nreal);
      ASSERT_EQ(p2g(mine[which], points, a.real), p2g(theirs[which], points, b.real));
      for (int c = 0; c < nreal; c++)
        ASSERT_LT(difference(a.column(c), b.column(c)), SAME)
            << "kernel " << which << ", " << count << " points, real " << c;
    }
}

TEST_P(Kernels, P2GBoxIsThatOfTheBaseNodesAndOnlyWidens)
{
  for (int count : {1, 2, 5, 64}) {
    Points points = random_points(count);
    Box expected = NO_BOX;
    for (int p = points.first; p < points.last; p++)
      for (int i = 0; i < dim; i++) {
        const double t = (points.x[3 * p + i] - points.step.origin[i]) / points.step.h -
            0.5 * (order - 1) - points.base[i];
        expected[i] = std::min(expected[i], static_cast<int>(std::floor(t)));
        expected[3 + i] = std::max(expected[3 + i], static_cast<int>(std::floor(t)));
      }
    Tile tile(dim, order, nreal);
    ASSERT_EQ(p2g(kernels.p2g, points, tile.real), expected);
    const Box wide = {-7, -7, -7, 77, 77, 77};
    ASSERT_EQ(p2g(kernels.p2g, points, tile.real, wide), wide);
  }
}

// total frame: stress is a full matrix, and places on the lattice are not the positions that move

TEST_P(TotalKernels, TotalFrame)
{
  const Case &c = GetParam();
  const TransferKernels total = table->transfer_total(dim, c.shape, c.transfer, c.split);
  const TransferKernels plain =
      MPMKernels::select("reference")->transfer_total(dim, c.shape, c.transfer, c.split);
  for (int count : {1, 2, 3, 8, 17, 64, 101})
    for (bool symmetric : {true, false}) {
      Points points = random_points(count);
      Reals P(points.nC * points.n), from(3 * points.n);
      fill(P), fill(from);
      if (symmetric) {
        // the updated frame is the case P = tau, from = x
        from = points.x;
        constexpr int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
        for (int p = 0; p < points.n; p++)
          for (int i = 0; i < dim; i++)
            for (int j = 0; j < dim; j++)
              P[points.nC * p + dim * j + i] = points.tau[6 * p + place[i][j]];
      }
      const TransferKernels &other = symmetric ? reference : plain;
      points.in_place = false;
      points.from = from.data();
      points.P = P.data();
      const P2G mine[] = {total.p2g, total.p2g_force}, theirs[] = {other.p2g, other.p2g_force};
      for (int which : {0, 1}) {
        Tile a(dim, order, nreal), b(dim, order, nreal);
        ASSERT_EQ(p2g(mine[which], points, a.real), p2g(theirs[which], points, b.real));
        for (int r = 0; r < nreal; r++)
          ASSERT_LT(difference(a.column(r), b.column(r)), SAME) << count << " points, real " << r;
      }

      // far away from the tile is as good as anywhere, but not nowhere
      const Tile field = random_field();
      Reals L(points.nC * count), L_other(L);
      Points before = points;
      EXPECT_EQ(g2p(total.g2p, points, field.real, L.data()), 0);
      g2p(other.g2p, before, field.real, L_other.data());
      EXPECT_LT(difference(points.xnew, before.xnew), SAME);
      EXPECT_LT(difference(points.v, before.v), SAME);
      EXPECT_LT(difference(points.C, before.C), SAME);
      EXPECT_LT(difference(L, L_other), SAME);
      from[3 * (points.last - 1)] = std::numeric_limits<double>::quiet_NaN();
      EXPECT_NE(g2p(total.g2p, points, field.real, L.data()), 0);
    }
}

TEST_P(Kernels, NoPointsNoChange)
{
  Points points = random_points(3);
  Tile tile(dim, order, nreal);
  points.first = points.last = 2;
  EXPECT_EQ(p2g(kernels.p2g, points, tile.real), NO_BOX);
  EXPECT_EQ(g2p(kernels.g2p, points, tile.real), 0);
  EXPECT_EQ(tile.sum(3), 0.0);
}

TEST_P(Kernels, MomentumAndForceMakeTheWhole)
{
  Points points = random_points(50);
  Tile a(dim, order, nreal), b(dim, order, nreal);
  p2g(kernels.p2g, points, a.real);
  p2g(kernels.p2g_momentum, points, b.real);
  if (split) {
    for (int c = 4; c < 8; c++)
      for (double f : b.column(c)) ASSERT_EQ(f, 0.0);
  }
  const double mass = b.sum(3);
  p2g(kernels.p2g_force, points, b.real);
  EXPECT_LT(difference(a.values(), b.values()), SAME);
  EXPECT_EQ(b.sum(3), mass);
}

TEST_P(ComparedKernels, G2PAgreesWithReference)
{
  for (int count : counts())
    for (int variant = 0; variant < 3; variant++) {
      const bool with_L = variant != 2;
      Points a = random_points(count), b = a;
      const Tile tile = random_field();
      Reals La(a.nC * count), Lb(a.nC * count);
      a.in_place = b.in_place = variant != 1;
      const int left_a = g2p(kernels.g2p, a, tile.real, with_L ? La.data() : nullptr);
      const int left_b = g2p(reference.g2p, b, tile.real, with_L ? Lb.data() : nullptr);
      const std::string what =
          std::to_string(count) + " points, variant " + std::to_string(variant);
      ASSERT_LT(difference(a.v, b.v), SAME) << what;
      ASSERT_LT(difference(a.x, b.x), SAME) << what;
      ASSERT_LT(difference(a.xnew, b.xnew), SAME) << what;
      ASSERT_LT(difference(a.C, b.C), SAME) << what;
      ASSERT_LT(difference(La, Lb), SAME) << what;
      ASSERT_EQ(left_a != 0, left_b != 0) << what;
    }
}

TEST_P(Kernels, GradientAgreesWithReferenceAndG2P)
{
  for (int count : {1, 2, 3, 8, 61, 64}) {
    Points a = random_points(count), before = a;
    const Tile tile = random_field();
    Reals La(a.nC * count), Lb(a.nC * count), Lc(a.nC * count);
    ASSERT_EQ(g2p(kernels.g2p_gradient, a, tile.real, La.data()), 0);
    g2p(reference.g2p_gradient, a, tile.real, Lb.data());
    ASSERT_LT(difference(La, Lb), SAME);
    ASSERT_EQ(a.x, before.x);
    ASSERT_EQ(a.v, before.v);
    ASSERT_EQ(a.C, before.C);
    ASSERT_EQ(a.xnew, before.xnew);
    // with velocities, of these points and along these axes only
    Reals va(3 * a.n, 7.0), vb = va;
    const auto with_velocity = [&](const TransferKernels &k, Reals &v, Reals &L) {
      PointRows rows = a.rows();
      rows.velocity = v.data();
      ASSERT_EQ(k.g2p_gradient(rows, a.step, a.first, a.last, a.base, tile.real, L.data()), 0);
    };
    with_velocity(kernels, va, Lc);
    with_velocity(reference, vb, Lb);
    ASSERT_EQ(La, Lc);
    ASSERT_LT(difference(va, vb), SAME);
    for (int i = 0; i < 3 * a.n; i++) {
      const bool asked = i / 3 >= a.first && i / 3 < a.last && i % 3 < dim;
      ASSERT_EQ(va[i] == 7.0, !asked);
    }
    ASSERT_EQ(a.v, before.v);

    g2p(kernels.g2p, a, tile.real, Lc.data());
    ASSERT_LT(difference(La, Lc), SAME);
    if (adds_change(GetParam().transfer)) continue;
    for (int p = a.first; p < a.last; p++)
      for (int i = 0; i < dim; i++) ASSERT_LT(std::abs(va[3 * p + i] - a.v[3 * p + i]), SAME);
  }
}

TEST_P(Kernels, OtherRowsAreLeftAlone)
{
  for (int trial = 0; trial < 10; trial++) {
    const int count = std::array<int, 5>{1, 2, 3, 16, 17}[trial / 2];
    Points points(dim, order, 3, count, 2, false);
    points.guarded = trial % 2 * (points.n - 1);
    const Points before = points;
    const Tile tile = random_field();
    // room behind the rows of L stands for the memory of somebody else
    Reals L(points.nC * (count + 1), 3.25);
    points.in_place = false;
    g2p(kernels.g2p, points, tile.real, L.data());
    auto check = [&](const Reals &now, const Reals &then, int width, const char *what) {
      for (int i = 0; i < width * points.n; i++)
        if (i < width * points.first || i >= width * points.last) {
          ASSERT_EQ(now[i], then[i]) << what << " " << i;
        }
    };
    check(points.v, before.v, 3, "v");
    check(points.xnew, before.xnew, 3, "xnew");
    check(points.C, before.C, points.nC, "C");
    EXPECT_EQ(points.x, before.x);
    for (int i = points.nC * count; i < points.nC * (count + 1); i++) ASSERT_EQ(L[i], 3.25);
  }
}

TEST_P(Kernels, MassAndMomentumAreConserved)
{
  Points points = random_points(173);
  Tile tile(dim, order, nreal);
  p2g(kernels.p2g_momentum, points, tile.real);
  double mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};
  for (int p = points.first; p < points.last; p++) {
    mass += points.mass[p];
    for (int i = 0; i < dim; i++) momentum[i] += points.mass[p] * points.v[3 * p + i];
  }
  // sums of about 1e4 positive node values
  EXPECT_NEAR(tile.sum(3), mass, 1e-13 * mass);
  for (int i = 0; i < 3; i++) EXPECT_NEAR(tile.sum(i), momentum[i], 1e-13 * mass) << "axis " << i;
}

TEST_P(Kernels, TotalForceIsTheExternalForce)
{
  Points points = random_points(173);
  Tile tile(dim, order, nreal);
  p2g(kernels.p2g_force, points, tile.real);
  const double scale = split ? 1.0 : points.step.dt;
  double force[3] = {0.0, 0.0, 0.0}, size = 0.0;
  for (int p = points.first; p < points.last; p++) {
    for (int i = 0; i < dim; i++) force[i] += scale * points.step.force_scale * points.f[3 * p + i];
    size += 2.0 * scale * (1.0 + points.vol0[p] * points.step.inv_h);
  }
  for (int i = 0; i < 3; i++)
    EXPECT_NEAR(tile.sum(split ? 4 + i : i), force[i], 1e-13 * size) << "axis " << i;
  EXPECT_EQ(tile.sum(3), 0.0);
}

TEST_P(Kernels, AngularMomentumIsConserved)
{
  Points points = random_points(101);
  Tile tile(dim, order, nreal);
  p2g(kernels.p2g_momentum, points, tile.real);
  const double reach = 100.0 * points.step.h;    // of positions, for the tolerance
  for (int k = dim == 3 ? 0 : 2; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    double expected = 0.0;
    for (int p = points.first; p < points.last; p++) {
      const double *x = &points.x[3 * p], *v = &points.v[3 * p];
      const double *C = &points.C[points.nC * p];
      expected += points.mass[p] * (x[i] * v[j] - x[j] * v[i]);
      if (!kernels.affine) continue;
      double moment[3];    // sum of w (x_i - x)^2 along each axis
      for (int a = 0; a < 3; a++) {
        const double t = (x[a] - points.step.origin[a]) / points.step.h;
        const double f = t - std::floor(t);
        moment[a] = order == 1 ? f * (1.0 - f) : (order == 2 ? 0.25 : 1.0 / 3.0);
        if (GetParam().shape == GIMP) {
          const double s = points.size[3 * p + a];
          double w[3];
          const double c = t - std::floor(t + 0.5);
          Gimp::weights(c + 0.5, s, w);
          moment[a] = w[0] * (c + 1.0) * (c + 1.0) + w[1] * c * c + w[2] * (1.0 - c) * (1.0 - c);
        }
        moment[a] *= points.step.h * points.step.h;
      }
      expected += points.mass[p] * (C[dim * i + j] * moment[i] - C[dim * j + i] * moment[j]);
    }
    EXPECT_NEAR(moment_of_nodes(points, tile, 0, k).first, expected, 1e-13 * reach * 101)
        << "axis " << k;
  }
}

TEST_P(Kernels, StressMakesNoTorque)
{
  Points points = random_points(101);
  std::fill(points.f.begin(), points.f.end(), 0.0);
  Tile tile(dim, order, nreal);
  p2g(kernels.p2g_force, points, tile.real);
  for (int k = dim == 3 ? 0 : 2; k < 3; k++) {
    const auto [torque, size] = moment_of_nodes(points, tile, split ? 4 : 0, k);
    EXPECT_NEAR(torque, 0.0, 1e-13 * size) << "axis " << k;
  }
}

TEST_P(Kernels, ConstantAndLinearFieldsAreExact)
{
  const Transfer transfer = GetParam().transfer;
  for (bool constant : {true, false}) {
    Points points = random_points(64);
    points.step.dt = 1.0e-3 * points.step.h;
    Reals a(3), B(9), b(3), D(9);
    fill(a), fill(B), fill(b), fill(D);
    if (constant) B = D = Reals(9, 0.0);
    if (dim == 2)
      for (int i : {2, 5, 6, 7, 8}) B[i] = D[i] = 0.0;
    const Tile tile = linear_field(points, a, B, b, D);
    const Points before = points;
    Reals L(points.nC * 64);
    g2p(kernels.g2p, points, tile.real, L.data());
    for (int p = points.first; p < points.last; p++) {
      const double *x = &before.x[3 * p];
      for (int i = 0; i < dim; i++) {
        double v = at(a, B, x, i);
        const double v_old = at(b, D, x, i);
        const double size = 200.0 * points.step.h + 10.0;    // of the terms in the field
        EXPECT_NEAR(points.x[3 * p + i], x[i] + points.step.dt * v, 1e-12 * size);
        if (adds_change(transfer))
          v = points.step.flip * (before.v[3 * p + i] + v - v_old) + (1.0 - points.step.flip) * v;
        EXPECT_NEAR(points.v[3 * p + i], v, 1e-12 * size);
      }
      for (int j = 0; j < dim; j++)
        for (int i = 0; i < dim; i++) {
          const int k = dim * j + i;
          const double Lk = L[points.nC * (p - points.first) + k];
          // velocities of size 100 h divided by h
          EXPECT_NEAR(Lk, B[3 * j + i], 1e-12 * (200.0 + 10.0 / points.step.h));
          EXPECT_EQ(points.C[points.nC * p + k], kernels.affine ? Lk : before.C[points.nC * p + k]);
        }
    }
  }
}

TEST_P(AffineKernels, FieldSurvivesTheRoundTrip)
{
  ASSERT_TRUE(kernels.affine);
  // Points carry the velocity a + B x and C = B: every node that gets mass gets the field's value.
  // Mass and momentum of nodes that a point just reaches are tiny and their ratio loses digits.
  Points points = random_points(200);
  Reals a(3), B(9);
  fill(a), fill(B);
  if (dim == 2)
    for (int i : {2, 5, 6, 7, 8}) B[i] = 0.0;
  for (int p = 0; p < points.n; p++) {
    const double *x = &points.x[3 * p];
    for (int i = 0; i < 3; i++) points.v[3 * p + i] = at(a, B, x, i);
    for (int j = 0; j < dim; j++)
      for (int i = 0; i < dim; i++) points.C[dim * (dim * p + j) + i] = B[3 * j + i];
  }
  Tile tile(dim, order, nreal);
  p2g(kernels.p2g_momentum, points, tile.real);
  table->solve_nodes(tile.real, tile.nodes, nreal, points.step.dt, MPM_NS::LEAST_MASS);
  const Tile exact = linear_field(points, a, B, a, B);
  const double size = 200.0 * points.step.h + 10.0;
  for (int n = 0; n < tile.nodes; n++) {
    if (tile.real[nreal * n + 3] < 1e-3) continue;
    for (int i = 0; i < dim; i++)
      EXPECT_NEAR(tile.real[nreal * n + i], exact.real[nreal * n + i], 1e-11 * size);
  }
}

TEST_P(SplitKernels, EqualMerged)
{
  const TransferKernels merged = table->transfer(dim, GetParam().shape, GetParam().transfer, false);
  ASSERT_EQ(merged.nreal, 4);
  Points a = random_points(150), b = a;
  Tile tile_a(dim, order, 8), tile_b(dim, order, 4);
  p2g(kernels.p2g, a, tile_a.real);
  p2g(merged.p2g, b, tile_b.real);
  table->solve_nodes(tile_a.real, tile_a.nodes, 8, a.step.dt, MPM_NS::LEAST_MASS);
  table->solve_nodes(tile_b.real, tile_b.nodes, 4, b.step.dt, MPM_NS::LEAST_MASS);
  Reals La(a.nC * 150), Lb(a.nC * 150);
  g2p(kernels.g2p, a, tile_a.real, La.data());
  g2p(merged.g2p, b, tile_b.real, Lb.data());
  // velocities of nodes with tiny mass lose digits and count little
  EXPECT_LT(difference(a.v, b.v), 1e-12);
  EXPECT_LT(difference(a.x, b.x), 1e-12);
  EXPECT_LT(difference(a.C, b.C), 1e-12);
  EXPECT_LT(difference(La, Lb), 1e-12);
}

TEST_P(Kernels, PointsThatLeaveTheTileAreReported)
{
  const int range = block_side(dim) + 2;
  for (int count : {1, 2, 7, 20})
    for (int axis = 0; axis < dim; axis++)
      for (double target :
           {-0.01, 0.01, range - 0.01, range + 0.01, std::numeric_limits<double>::quiet_NaN()}) {
        Points points = random_points(count);
        // all start in the middle, but one that ends at the target
        const Reals zero(9, 0.0);
        const int p = integer(points.first, points.last - 1);
        const double x = points.step.origin[axis] +
            (target + 0.5 * (order - 1) + points.base[axis]) * points.step.h;
        Reals a(3, 0.0);
        for (int q = points.first; q < points.last; q++)
          for (int i = 0; i < 3; i++)
            points.x[3 * q + i] = points.step.origin[i] +
                (0.5 * range + 0.5 * (order - 1) + points.base[i]) * points.step.h;
        a[axis] = 0.02 * points.step.h / points.step.dt * (target < 0.5 * range ? -1.0 : 1.0);
        const bool outside = !(target >= 0.0 && target < range);
        if (std::isnan(target))
          a[axis] = target;
        else
          points.x[3 * p + axis] = x - points.step.dt * a[axis];
        const Tile tile = linear_field(points, a, zero, a, zero);
        Reals L(points.nC * count);
        EXPECT_EQ(g2p(kernels.g2p, points, tile.real, L.data()) != 0, outside)
            << "target " << target;
      }
}

TEST_P(PlaneKernels, LeaveZAlone)
{
  Points points = random_points(33);
  const Points before = points;
  Tile tile(dim, order, nreal);
  const Box box = p2g(kernels.p2g, points, tile.real);
  EXPECT_EQ(box[2], 1000);
  EXPECT_EQ(box[5], -1000);
  for (double pz : tile.column(2)) ASSERT_EQ(pz, 0.0);

  const Tile field = random_field();
  points.in_place = false;
  g2p(kernels.g2p, points, field.real);
  for (int p = points.first; p < points.last; p++) {
    EXPECT_EQ(points.v[3 * p + 2], before.v[3 * p + 2]);
    EXPECT_EQ(points.xnew[3 * p + 2], before.x[3 * p + 2]);
  }
}

TEST_P(Kernels, TileMovesItsBox)
{
  Tile tile(dim, order, nreal);
  expect_box_moves(kernels,
                   {dim, tile_stride_x(dim, order), tile_stride_y(dim, order), 1,
                    block_side(dim) + 1, order, tile.real, tile.nodes * nreal});
}

const std::vector<Shape> shapes = {LINEAR, QUADRATIC, CUBIC, GIMP};
bool has_total_frame(const Case &c)
{
  return c.shape != GIMP && c.transfer != AFLIP;
}
bool has_affine_field(const Case &c)
{
  return is_affine(c.transfer);
}
bool is_split_by_choice(const Case &c)
{
  return may_be_merged(c.transfer) && c.split;
}
bool is_plane(const Case &c)
{
  return c.dim == 2;
}

INSTANTIATE_TEST_SUITE_P(All, Kernels, all_cases(shapes), case_name);
INSTANTIATE_TEST_SUITE_P(All, ComparedKernels, all_cases(shapes, is_not_reference), case_name);
INSTANTIATE_TEST_SUITE_P(All, TotalKernels, all_cases(shapes, has_total_frame), case_name);
INSTANTIATE_TEST_SUITE_P(All, AffineKernels, all_cases(shapes, has_affine_field), case_name);
INSTANTIATE_TEST_SUITE_P(All, SplitKernels, all_cases(shapes, is_split_by_choice), case_name);
INSTANTIATE_TEST_SUITE_P(All, PlaneKernels, all_cases(shapes, is_plane), case_name);

class Tables : public ::testing::TestWithParam<const char *> {
 protected:
  const MPMKernels *table;
  void SetUp() override
  {
    table = MPMKernels::select(GetParam());
    if (!table) GTEST_SKIP() << "the CPU does not have it, or the compiler does not know it";
  }
};

/** Rows to a batch: F <- (I + dt L) F, Cauchy stress with the old volume; back with the new one. */
TEST_P(Tables, BatchesAgreeWithMatrixAlgebra)
{
  for (int dim : {2, 3})
    for (int n : {1, 2, 3, 4, 5, 7, 8, 9, 31, 63, 64}) {
      const auto *kernels = BatchKernels::select(dim, GetParam());
      ASSERT_NE(kernels, nullptr);
      const int nL = dim * dim;
      const double dt = 0.1;
      Reals L(nL * n), F(9 * n, 0.0), tau(6 * n, 0.0), vol0(n);
      fill(L), fill(vol0);
      for (int p = 0; p < n; p++) {
        for (int i = 0; i < dim; i++)
          for (int j = 0; j < dim; j++) F[9 * p + 3 * i + j] = (i == j) + uniform(-0.3, 0.3);
        if (dim == 2) F[9 * p + 8] = uniform(0.5, 2.0);
        for (int c = 0; c < (dim == 2 ? 4 : 6); c++) tau[6 * p + c] = uniform(-1.0, 1.0);
      }
      const int inverted = n > 8 ? integer(0, n - 1) : -1;
      if (inverted >= 0) L[nL * inverted] = -1000.0;

      auto b = std::make_unique<Batch>();
      kernels->load(*b, n, dt, L.data(), F.data(), tau.data(), vol0.data(), nullptr);
      EXPECT_EQ(b->n, n);
      EXPECT_EQ(b->dt, dt);
      std::vector<std::array<double, 9>> expected(n);
      for (int p = 0; p < n; p++) {
        double A[9] = {0.0};
        for (int i = 0; i < dim; i++)
          for (int j = 0; j < dim; j++) A[3 * i + j] = dt * L[nL * p + dim * j + i];
        const double *f = &F[9 * p];
        for (int i = 0; i < 3; i++)
          for (int j = 0; j < 3; j++) {
            double &g = expected[p][3 * i + j];
            g = f[3 * i + j];
            for (int k = 0; k < 3; k++) g += A[3 * i + k] * f[3 * k + j];
          }
        const double size = p == inverted ? 1.0e3 : 1.0;
        for (int c = 0; c < 9; c++) {
          EXPECT_NEAR(b->A[c][p], A[c], 1e-15 * size);
          EXPECT_NEAR(b->F[c][p], expected[p][c], 1e-14 * size);
        }
        EXPECT_NEAR(b->Jold[p], determinant(f), 1e-14);
        EXPECT_NEAR(b->J[p], determinant(expected[p].data()), 1e-13 * size);
        EXPECT_EQ(b->vol0[p], vol0[p]);
        for (int c = 0; c < 6; c++)
          EXPECT_NEAR(b->stress[c][p], tau[6 * p + c] / determinant(f), 1e-14 / determinant(f));
      }

      for (int p = 0; p < n; p++)
        for (int c = 0; c < (dim == 2 ? 4 : 6); c++) b->stress[c][p] = uniform(-1.0, 1.0);
      const bool bad = inverted >= 0 && !(b->J[inverted] > 0.0);
      const Reals F_before = F, tau_before = tau;
      EXPECT_EQ(kernels->store(*b, F.data(), tau.data()), bad);
      for (int p = 0; p < n; p++) {
        const bool kept = bad && p == inverted;
        for (int c = 0; c < 9; c++)
          EXPECT_EQ(F[9 * p + c], kept ? F_before[9 * p + c] : b->F[c][p]);
        for (int c = 0; c < 6; c++)
          EXPECT_EQ(tau[6 * p + c], kept ? tau_before[6 * p + c] : b->J[p] * b->stress[c][p]);
      }
    }
}

/** A shape that is far from that of the start is forgotten, and J is kept: stretch ratios of 100
 *  against those of a pure change of volume, in 2d in the plane. */
TEST_P(Tables, FarShapesAreForgotten)
{
  for (int dim : {2, 3})
    for (int n : {1, 5, 8, 64}) {
      const auto *kernels = BatchKernels::select(dim, GetParam());
      ASSERT_NE(kernels, nullptr);
      auto b = std::make_unique<Batch>();
      memset(b.get(), 0, sizeof(Batch));
      b->n = n;
      const double stretches[] = {0.3, 1.0, 2.5}, shears[] = {0.0, 99.0, -101.0, 1.0e9};
      const auto sheared = [dim](int p) {    // any that is not on the diagonal
        constexpr int of_space[] = {6, 1, 2, 3, 5, 7}, of_plane[] = {3, 1};
        return dim == 3 ? of_space[p % 6] : of_plane[p % 2];
      };
      std::vector<double> shear(n), size(n);
      for (int p = 0; p < n; p++) {
        shear[p] = shears[p % 4];
        size[p] = stretches[p % 3];
        for (int d = 0; d < 3; d++) b->F[4 * d][p] = d < dim ? size[p] : 7.0;
        b->F[sheared(p)][p] = shear[p] * size[p];
        b->J[p] = pow(size[p], dim) * (dim == 3 ? 1.0 : 7.0);
      }
      const bool inverted = n > 8;
      if (inverted) b->J[7] = -1.0;
      const auto before = *b;
      kernels->forget_shape(*b);
      for (int p = 0; p < n; p++) {
        EXPECT_EQ(b->J[p], before.J[p]);
        const bool forgotten = fabs(shear[p]) > 100.0 && !(inverted && p == 7);
        for (int c = 0; c < 9; c++)
          if (forgotten)
            EXPECT_NEAR(b->F[c][p], c % 4 ? 0.0 : c == 8 && dim == 2 ? 7.0 : size[p], 1e-15 * 7.0);
          else
            EXPECT_EQ(b->F[c][p], before.F[c][p]);
      }
    }
}

TEST_P(Tables, SolveNodes)
{
  const int n = 37;
  const double dt = 0.25;
  for (const int nreal : {4, 8}) {
    const bool split = nreal == 8;
    Reals nodes(nreal * n);
    fill(nodes);
    for (int i = 0; i < n; i++) {
      nodes[nreal * i + 3] = i % 5 ? uniform(0.1, 1.0) : 0.0;
      if (split) nodes[nreal * i + 7] = 0.0;
    }
    const Reals before = nodes;
    table->solve_nodes(nodes.data(), n, nreal, dt, MPM_NS::LEAST_MASS);
    for (int i = 0; i < n; i++) {
      const double *p = &before[nreal * i], *v = &nodes[nreal * i], m = p[3];
      for (int a = 0; a < 3; a++) {
        const double new_p = split ? p[a] + dt * p[4 + a] : p[a];
        EXPECT_NEAR(v[a], m > 0.0 ? new_p / m : 0.0, 1e-14);
        if (split) { EXPECT_NEAR(v[4 + a], m > 0.0 ? p[a] / m : 0.0, 1e-14); }
      }
      EXPECT_EQ(v[3], m);
      if (split) { EXPECT_EQ(v[7], 0.0); }
    }
  }
}

TEST_P(Tables, SaysWhatItHas)
{
  for (int dim : {2, 3})
    for (Shape shape : {LINEAR, QUADRATIC, CUBIC, GIMP, CPDI, CPDI2})
      for (Transfer transfer : {PIC, FLIP, APIC, AFLIP, TPIC})
        for (bool split : {false, true}) {
          const TransferKernels k = table->transfer(dim, shape, transfer, split);
          EXPECT_EQ(k.nreal, split || !may_be_merged(transfer) ? 8 : 4);
          EXPECT_EQ(k.affine, transfer == APIC || transfer == AFLIP || transfer == TPIC);
          EXPECT_EQ(k.gradient_in_C,
                    transfer == TPIC || (k.affine && shape != CPDI && shape != CPDI2));
          EXPECT_TRUE(k.p2g && k.p2g_momentum && k.p2g_force && k.g2p && k.g2p_gradient &&
                      k.flush && k.load);
        }
}

INSTANTIATE_TEST_SUITE_P(All, Tables, ::testing::Values("reference", "baseline", "avx2", "avx512"));

TEST(Select, ByName)
{
  unsetenv("MPM_ISA");
  const MPMKernels *best = MPMKernels::select();
  ASSERT_NE(best, nullptr);
  EXPECT_STRNE(best->isa, "reference");
  EXPECT_EQ(MPMKernels::select(""), best);
  EXPECT_STREQ(MPMKernels::select("reference")->isa, "reference");
  EXPECT_STREQ(MPMKernels::select("baseline")->isa, "baseline");
  if (const MPMKernels *table = MPMKernels::select("avx2")) { EXPECT_STREQ(table->isa, "AVX2"); }
  if (const MPMKernels *table = MPMKernels::select("avx512")) {
    EXPECT_STREQ(table->isa, "AVX-512");
    EXPECT_EQ(table, best);
  }
  EXPECT_EQ(MPMKernels::select("mmx"), nullptr);
}

TEST(Select, ByEnvironment)
{
  setenv("MPM_ISA", "reference", 1);
  EXPECT_STREQ(MPMKernels::select()->isa, "reference");
  EXPECT_STREQ(MPMKernels::select("baseline")->isa, "baseline");
  setenv("MPM_ISA", "abacus", 1);
  EXPECT_EQ(MPMKernels::select(), nullptr);
  unsetenv("MPM_ISA");
}
