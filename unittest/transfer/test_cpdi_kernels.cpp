// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit
// timeout: 300

// Domains of points (CPDI): their weights against quadrature, and the transfers of every
// instruction set against the plain loops and against what every transfer must do.

#include "transfer/cpdi.h"
#include "transfer/kernel_testing.h"

using namespace MPM_NS;
using namespace MPM_TEST;

/** Corners of a cube of half edge size, each moved by up to noise. */
template <int DIM> void distorted(double size, double noise, double *x)
{
  for (int c = 0; c < 1 << DIM; c++)
    for (int d = 0; d < DIM; d++)
      x[DIM * c + d] = size * PointDomain<DIM>::sign(c, d) + uniform(-noise, noise);
}

/** The means by Gauss points of high order, from nothing but the map. */
template <int DIM> double by_quadrature(const double *x, double *w, double *g)
{
  constexpr int N = 1 << DIM;
  static const double at[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                               0.8611363115940526};
  static const double weight[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                   0.3478548451374538};
  std::fill(w, w + N, 0.0), std::fill(g, g + N * DIM, 0.0);
  double volume = 0.0;
  for (int q = 0; q < (DIM == 3 ? 64 : 16); q++) {
    const int i[3] = {q & 3, q >> 2 & 3, q >> 4 & 3};
    double measure = 1.0, M[N], slope[N][3];
    double map[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, DIM == 2 ? 1.0 : 0.0}};
    for (int d = 0; d < DIM; d++) measure *= weight[i[d]];
    for (int c = 0; c < N; c++) {
      M[c] = 1.0;
      for (int d = 0; d < DIM; d++) M[c] *= 0.5 * (1.0 + PointDomain<DIM>::sign(c, d) * at[i[d]]);
      for (int k = 0; k < DIM; k++) {
        slope[c][k] = 0.5 * PointDomain<DIM>::sign(c, k);
        for (int d = 0; d < DIM; d++)
          if (d != k) slope[c][k] *= 0.5 * (1.0 + PointDomain<DIM>::sign(c, d) * at[i[d]]);
        for (int d = 0; d < DIM; d++) map[d][k] += slope[c][k] * x[DIM * c + d];
      }
    }
    const auto &m = map;
    double inverse[3][3];    // times the determinant
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        inverse[b][a] = m[(a + 1) % 3][(b + 1) % 3] * m[(a + 2) % 3][(b + 2) % 3] -
            m[(a + 1) % 3][(b + 2) % 3] * m[(a + 2) % 3][(b + 1) % 3];
    const double J = m[0][0] * inverse[0][0] + m[0][1] * inverse[1][0] + m[0][2] * inverse[2][0];
    volume += measure * J;
    for (int c = 0; c < N; c++) {
      w[c] += measure * J * M[c];
      for (int d = 0; d < DIM; d++)
        for (int k = 0; k < DIM; k++) g[DIM * c + d] += measure * slope[c][k] * inverse[k][d];
    }
  }
  for (int c = 0; c < N; c++) w[c] /= volume;
  for (int c = 0; c < N * DIM; c++) g[c] /= volume;
  return volume;
}

template <int DIM> void check_weights()
{
  constexpr int N = 1 << DIM, K = N * DIM;
  for (int trial = 0; trial < 50; trial++) {
    double x[K], w[N], g[K], w_exact[N], g_exact[K];
    distorted<DIM>(1.0, 0.4, x);
    if (trial % 3 == 1)    // a triangle, a tetrahedron
      for (int d = 0; d < DIM; d++) {
        x[3 * DIM + d] = x[2 * DIM + d];
        for (int c = 5; c < N; c++) x[DIM * c + d] = x[4 * DIM + d];
      }
    const double size = PointDomain<DIM>::free(x, w, g);
    EXPECT_NEAR(size, by_quadrature<DIM>(x, w_exact, g_exact), 1e-13);
    for (int c = 0; c < N; c++) EXPECT_NEAR(w[c], w_exact[c], 1e-14);
    for (int c = 0; c < K; c++) EXPECT_NEAR(g[c], g_exact[c], 1e-13);

    // partition of unity; fields a + b x are exact
    double sum = 0.0;
    for (int c = 0; c < N; c++) sum += w[c];
    EXPECT_NEAR(sum, 1.0, 1e-14);
    for (int i = 0; i < DIM; i++)
      for (int j = 0; j < DIM; j++) {
        double gx = 0.0, g1 = 0.0;
        for (int c = 0; c < N; c++) gx += g[DIM * c + i] * x[DIM * c + j], g1 += g[DIM * c + i];
        EXPECT_NEAR(gx, i == j, 1e-13);
        EXPECT_NEAR(g1, 0.0, 1e-14);
      }
  }
}

TEST(Weights, OfFreeDomains)
{
  check_weights<2>();    // quadrilaterals and triangles
  check_weights<3>();    // hexahedra and tetrahedra
}

// of integers: volume 1/6 (0 in integers), each corner a fourth
TEST(Weights, TetrahedronHasItsVolume)
{
  const double a[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  double w[8], g[24];
  EXPECT_NEAR(PointDomain<3>::free(a, w, g), 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(w[0], 0.25, 1e-15);
  EXPECT_NEAR(w[2] + w[3], 0.25, 1e-15);
  EXPECT_NEAR(w[4] + w[5] + w[6] + w[7], 0.25, 1e-15);
  EXPECT_NEAR(g[3 * 1], 1.0, 1e-14);    // grad of x
}

template <int DIM> void check_box()
{
  constexpr int N = 1 << DIM, K = N * DIM;
  Reals r(DIM * DIM);
  for (int trial = 0; trial < 20; trial++) {
    fill(r, 0.4);
    for (int d = 0; d < DIM; d++) r[DIM * d + d] += 1.0;
    double x[K], g[K], w_free[N], g_free[K];
    const double size = PointDomain<DIM>::box(r.data(), x, g);
    EXPECT_NEAR(size, PointDomain<DIM>::free(x, w_free, g_free), 1e-13);
    for (int c = 0; c < N; c++) EXPECT_NEAR(w_free[c], 1.0 / N, 1e-15);
    for (int k = 0; k < K; k++) EXPECT_NEAR(g[k], g_free[k], 1e-13);
  }
}

TEST(Weights, BoxesAreFreeDomains)
{
  check_box<2>();
  check_box<3>();
}

/** Points in the middle block of a tile, with domains that reach up to 3 cells. */
struct Points {
  int dim, first, last, n, N, row;
  TransferStep step = random_step();
  int base[3];
  Reals x, v, f, C, tau, vol0, mass, xnew, domain, corners_new;

  Points(int dim, Shape shape, int n) :
      dim(dim), first(0), last(n), n(n), N(1 << dim),
      row(shape == CPDI ? dim * dim : dim << dim), base{-7, 5, 11}, x(3 * n), v(3 * n), f(3 * n),
      C(dim * dim * n), tau(6 * n), vol0(n), mass(n), xnew(3 * n), domain(row * n),
      corners_new(row * n)
  {
    fill(v), fill(f), fill(C), fill(tau);
    for (double &a : vol0) a = uniform(0.5, 1.5) * std::pow(step.h, dim);
    for (double &a : mass) a = uniform(0.5, 1.5);
    const int side = block_side(dim);
    for (int p = 0; p < n; p++) {
      for (int d = 0; d < 3; d++)
        x[3 * p + d] = step.origin[d] + (base[d] + side + uniform(0.0, side)) * step.h;
      const double size = uniform(0.1, 2.0) * step.h;
      if (shape == CPDI)
        for (int k = 0; k < row; k++)
          domain[row * p + k] = size * (k % (dim + 1) == 0) + 0.2 * size * uniform(-1.0, 1.0);
      else if (dim == 2)
        distorted<2>(size, 0.3 * size, &domain[row * p]);
      else
        distorted<3>(size, 0.3 * size, &domain[row * p]);
    }
  }

  PointRows rows()
  {
    PointRows r{x.data(),   v.data(),    f.data(),    C.data(),
                tau.data(), vol0.data(), mass.data(), xnew.data()};
    r.domain = domain.data();
    r.corners_new = corners_new.data();
    return r;
  }

  /** Corners of a domain in space, their weights, the center. */
  struct Corners {
    double x[24], w[8], g[24], center[3];
  };
  Corners corners(int p) const
  {
    Corners c = {};
    const double *r = &domain[row * p];
    std::fill(c.w, c.w + 8, 1.0 / N);
    if (row == dim * dim)
      dim == 2 ? PointDomain<2>::box(r, c.x, c.g) : PointDomain<3>::box(r, c.x, c.g);
    else {
      std::copy(r, r + row, c.x);
      dim == 2 ? PointDomain<2>::free(r, c.w, c.g) : PointDomain<3>::free(r, c.w, c.g);
    }
    for (int d = 0; d < dim; d++) {
      c.center[d] = 0.0;
      for (int k = 0; k < N; k++) {
        c.x[dim * k + d] += x[3 * p + d];
        c.center[d] += c.w[k] * c.x[dim * k + d];
      }
    }
    return c;
  }

  void node_position(int index, double *position) const
  {
    const int sx = domain_stride_x(dim), sy = domain_stride_y(dim);
    const int i[3] = {index / sx, dim == 3 ? index % sx / sy : index % sx,
                      dim == 3 ? index % sx % sy : 0};
    for (int a = 0; a < 3; a++) position[a] = step.origin[a] + (base[a] + i[a]) * step.h;
  }
};

class DomainKernels : public KernelTest {
 protected:
  int nodes;
  Shape shape;

  void SetUp() override
  {
    KernelTest::SetUp();
    shape = GetParam().shape;
    nodes = domain_tile_nodes(GetParam().dim);
  }
  Reals tile() const { return Reals(nodes * nreal, 0.0); }
};

// Tests of what only some of the combinations have: see the lists at the end.
class ApicKernels : public DomainKernels {};
class FreeCorners : public DomainKernels {};

TEST_P(DomainKernels, AgreeWithTheReference)
{
  for (int n : {1, 3, 8, 21}) {
    Points a(dim, shape, n), b = a;
    for (int k = 0; k < 3; k++) {
      const P2G mine[] = {kernels.p2g, kernels.p2g_momentum, kernels.p2g_force};
      const P2G theirs[] = {reference.p2g, reference.p2g_momentum, reference.p2g_force};
      Reals s = tile(), t = tile();
      ASSERT_EQ(p2g(mine[k], a, s.data()), p2g(theirs[k], b, t.data()));
      ASSERT_LT(difference(s, t), 1e-13) << k;
    }
    Reals field = tile(), La(dim * dim * n), Lb(La);
    fill(field);
    EXPECT_EQ(g2p(kernels.g2p, a, field.data(), La.data()), 0);
    EXPECT_EQ(g2p(reference.g2p, b, field.data(), Lb.data()), 0);
    EXPECT_LT(difference(La, Lb), 1e-12);
    EXPECT_LT(difference(a.v, b.v), 1e-13);
    EXPECT_LT(difference(a.C, b.C), 1e-12);
    for (int p = 0; dim == 2 && p < n; p++) EXPECT_EQ(a.xnew[3 * p + 2], a.x[3 * p + 2]);
    EXPECT_LT(difference(a.xnew, b.xnew), 1e-13);
    EXPECT_LT(difference(a.corners_new, b.corners_new), 1e-12);
    std::fill(Lb.begin(), Lb.end(), 0.0);
    g2p(kernels.g2p_gradient, b, field.data(), Lb.data());
    EXPECT_LT(difference(La, Lb), 1e-13);
  }
}

TEST_P(DomainKernels, MassMomentumAndForceAreConserved)
{
  Points points(dim, shape, 50);
  for (const bool force : {false, true}) {
    Reals t = tile();
    p2g(force ? kernels.p2g_force : kernels.p2g_momentum, points, t.data());
    const int lane = force && nreal == 8 ? 4 : 0;
    double sum[4] = {0.0}, exact[4] = {0.0}, torque[3] = {0.0}, size = 1.0;
    for (int n = 0; n < nodes; n++) {
      double x[3];
      points.node_position(n, x);
      for (int r = 0; r < 4; r++) sum[r] += t[nreal * n + lane + r];
      for (int d = dim == 3 ? 0 : 2; d < 3; d++)
        torque[d] += x[(d + 1) % 3] * t[nreal * n + lane + (d + 2) % 3] -
            x[(d + 2) % 3] * t[nreal * n + lane + (d + 1) % 3];
    }
    for (int p = 0; p < points.n; p++) {
      const double factor = !force ? points.mass[p]
                                   : points.step.force_scale * (nreal == 8 ? 1.0 : points.step.dt);
      double a[3];
      for (int d = 0; d < 3; d++) {
        a[d] = factor * (force ? points.f[3 * p + d] : points.v[3 * p + d]);
        if (d < dim) exact[d] += a[d];
      }
      if (!force) exact[3] += points.mass[p];
      // symmetric stress makes no torque
      const auto c = points.corners(p);
      for (int d = dim == 3 ? 0 : 2; d < 3; d++)
        torque[d] -=
            c.center[(d + 1) % 3] * a[(d + 2) % 3] - c.center[(d + 2) % 3] * a[(d + 1) % 3];
      for (double g : c.g) size += std::abs(g) * points.vol0[p];
      size += 100.0 * points.step.h;
    }
    for (int r = 0; r < 4; r++) EXPECT_NEAR(sum[r], exact[r], 1e-14 * size);
    if (force || !kernels.affine) {
      for (double m : torque) EXPECT_NEAR(m, 0.0, 1e-13 * size * (1.0 + points.step.h));
    }
  }
}

TEST_P(DomainKernels, LinearFieldsAreExact)
{
  Points points(dim, shape, 40);
  Reals a(3), B(9), t = tile(), L(dim * dim * points.n);
  fill(a), fill(B);
  const auto field = [&](const double *x, int i) {
    double v = a[i];
    for (int j = 0; j < dim; j++) v += B[3 * j + i] * x[j];
    return v;
  };
  for (int n = 0; n < nodes; n++) {
    double x[3];
    points.node_position(n, x);
    for (int i = 0; i < dim; i++)
      for (int old = 0; old < nreal; old += 4) t[nreal * n + old + i] = field(x, i);
  }
  const Points before = points;
  g2p(kernels.g2p, points, t.data(), L.data());
  const double size = 100.0 * points.step.h + 10.0;
  for (int p = 0; p < points.n; p++) {
    const auto c = before.corners(p);
    const double flip = adds_change(GetParam().transfer) ? points.step.flip : 0.0;
    for (int i = 0; i < dim; i++) {
      const double v = field(c.center, i);
      EXPECT_NEAR(points.v[3 * p + i], v + flip * (before.v[3 * p + i] - v), 1e-13 * size);
      EXPECT_NEAR(points.xnew[3 * p + i], c.center[i] + points.step.dt * v, 1e-13 * size);
      for (int j = 0; j < dim; j++) {
        EXPECT_NEAR(L[dim * dim * p + dim * j + i], B[3 * j + i], 1e-12 * (1.0 + size));
        if (kernels.affine) {
          EXPECT_NEAR(points.C[dim * dim * p + dim * j + i], B[3 * j + i], 1e-12 * (1.0 + size));
        }
      }
      if (shape == CPDI2) {    // corners move with the field
        for (int k = 0; k < points.N; k++)
          EXPECT_NEAR(points.xnew[3 * p + i] + points.corners_new[points.row * p + dim * k + i],
                      c.x[dim * k + i] + points.step.dt * field(c.x + dim * k, i), 1e-13 * size);
      }
    }
  }

  // and back: nodes that get mass from points with this field have its values
  if (!kernels.affine) return;
  points = before;
  for (int p = 0; p < points.n; p++) {
    const auto c = points.corners(p);
    for (int i = 0; i < dim; i++) {
      points.v[3 * p + i] = field(c.center, i);
      for (int j = 0; j < dim; j++) points.C[dim * dim * p + dim * j + i] = B[3 * j + i];
    }
  }
  Reals back = tile();
  p2g(kernels.p2g_momentum, points, back.data());
  for (int n = 0; n < nodes; n++) {
    double x[3];
    points.node_position(n, x);
    const double m = back[nreal * n + 3];
    for (int i = 0; i < dim && m > 1e-3; i++)
      EXPECT_NEAR(back[nreal * n + i] / m, field(x, i), 1e-11 * size);
  }
}

/** Mass, energy, and angular momentum of what points have given to the nodes. */
struct NodeSums {
  double mass = 0.0, energy = 0.0, spin[3] = {0.0};

  NodeSums(const Points &points, const Reals &tile, int nreal, int nodes)
  {
    for (int n = 0; n < nodes; n++) {
      const double *p = &tile[nreal * n];
      if (!(p[3] > 0.0)) continue;
      double x[3];
      points.node_position(n, x);
      mass += p[3];
      for (int d = 0; d < 3; d++) {
        energy += 0.5 * p[d] * p[d] / p[3];
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        if (points.dim == 3 || d == 2) spin[d] += x[e] * p[f] - x[f] * p[e];
      }
    }
  }
};

// from nodes to points and back, the field stays as it is: APIC keeps all of its angular momentum

TEST_P(ApicKernels, KeepAngularMomentum)
{
  Points points(dim, shape, 40);
  points.step.flip = 0.0;
  for (double &o : points.step.origin) o = -8.0 * points.step.h;    // spin about a place nearby
  points.base[0] = points.base[1] = points.base[2] = 0;
  for (int p = 0; p < points.n; p++)
    for (int d = 0; d < 3; d++)
      points.x[3 * p + d] =
          points.step.origin[d] + (block_side(dim) * (1.0 + uniform(0.0, 1.0))) * points.step.h;
  Reals t = tile();
  p2g(kernels.p2g_momentum, points, t.data());
  const NodeSums before(points, t, nreal, nodes);
  for (int n = 0; n < nodes; n++)
    for (int i = 0; i < 3 && t[nreal * n + 3] > 0.0; i++) t[nreal * n + i] /= t[nreal * n + 3];
  g2p(kernels.g2p, points, t.data());
  t = tile();
  p2g(kernels.p2g_momentum, points, t.data());
  const NodeSums after(points, t, nreal, nodes);
  EXPECT_LT(after.energy, before.energy);
  for (int d = 0; d < 3; d++)
    EXPECT_NEAR(after.spin[d], before.spin[d], 1e-13 * before.mass * 8.0 * points.step.h);
}

// Again and again from points to nodes and back: with APIC no field gains energy, as a point's
// affine field is the nearest to what nodes have. That of TPIC is not: in domains that are sheared
// by 6, waves as long as a domain grow, fastest where corners are on nodes.

TEST_P(DomainKernels, ShearedDomainsGainNoEnergy)
{
  const Transfer transfer = GetParam().transfer;
  const int along = 2 * block_side(dim), n = dim == 3 ? along * along * along : along * along;
  Points points(dim, shape, n);
  const double h = points.step.h;
  points.step.flip = 0.0;
  for (int p = 0; p < n; p++) {
    const int i[3] = {p % along, p / along % along, dim == 3 ? p / along / along : 0};
    for (int d = 0; d < dim; d++)
      points.x[3 * p + d] =
          points.step.origin[d] + (points.base[d] + block_side(dim) + 0.5 * (i[d] + 0.5)) * h;
    points.mass[p] = 1.0;
    double edge[9] = {0.0}, gradient[24];
    for (int d = 0; d < dim; d++) edge[dim * d + d] = 0.25 * h;
    edge[dim] = 6.0 * 0.25 * h;
    double *domain = &points.domain[points.row * p];
    if (shape == CPDI)
      std::copy(edge, edge + dim * dim, domain);
    else
      dim == 2 ? PointDomain<2>::box(edge, domain, gradient)
               : PointDomain<3>::box(edge, domain, gradient);
  }
  double energy = 0.0, first = 0.0;
  const int rounds = SANITIZED ? 2 : 30;
  for (int round = 0; round < rounds; round++) {
    Reals t = tile();
    p2g(kernels.p2g_momentum, points, t.data());
    const double now = NodeSums(points, t, nreal, nodes).energy;
    if (round == 0) first = now;
    if (round > 0 && transfer != TPIC) { ASSERT_LE(now, energy * (1.0 + 1e-14)) << round; }
    energy = now;
    for (int k = 0; k < nodes; k++)
      for (int i = 0; i < 3; i++)
        t[nreal * k + i] = t[nreal * k + 3] > 0.0 ? t[nreal * k + i] / t[nreal * k + 3] : 0.0;
    g2p(kernels.g2p, points, t.data());
  }
  if (transfer == TPIC && !SANITIZED) { EXPECT_GT(energy, first); }
}

TEST_P(DomainKernels, InvertedDomainsAreReported)
{
  for (int which : {0, 7, 12}) {
    Points points(dim, shape, 13);
    for (int d = 0; d < dim; d++) {    // two corners, or two ends of an edge, change places
      double *domain = &points.domain[points.row * which];
      if (shape == CPDI)
        domain[d] = -domain[d];
      else
        for (int k = 0; k < points.N; k += 2)
          std::swap(domain[dim * k + d], domain[dim * (k + 1) + d]);
    }
    Reals field = tile();
    EXPECT_NE(g2p(kernels.g2p, points, field.data()), 0);
  }
}

// a corner pushed in nearly to the opposite one: the size is positive, but not all weights are

TEST_P(FreeCorners, OfFoldedDomainsAreReported)
{
  for (int which : {0, 7, 12}) {
    Points points(dim, shape, 13);
    double *x = &points.domain[points.row * which], w[8], g[24];
    for (int c = 0; c < points.N; c++)
      for (int d = 0; d < dim; d++)
        x[dim * c + d] =
            0.3 * points.step.h * (c == points.N - 1 ? -0.9 : PointDomain<3>::sign(c, d));
    ASSERT_GT(dim == 2 ? PointDomain<2>::free(x, w, g) : PointDomain<3>::free(x, w, g), 0.0);
    ASSERT_LT(*std::min_element(w, w + points.N), 0.0);
    const Reals field = tile();
    EXPECT_NE(g2p(kernels.g2p, points, field.data()), 0);
  }
}

TEST_P(DomainKernels, TileMovesItsBox)
{
  Reals t = tile();
  expect_box_moves(kernels,
                   {dim, domain_stride_x(dim), domain_stride_y(dim), block_side(dim),
                    domain_tile_side(dim) - 2, 1, t.data(), nodes * nreal});
}

bool is_apic(const Case &c)
{
  return c.transfer == APIC || c.transfer == AFLIP;
}

INSTANTIATE_TEST_SUITE_P(All, DomainKernels, all_cases({CPDI, CPDI2}), case_name);
INSTANTIATE_TEST_SUITE_P(All, ApicKernels, all_cases({CPDI, CPDI2}, is_apic), case_name);
INSTANTIATE_TEST_SUITE_P(All, FreeCorners, all_cases({CPDI2}), case_name);
