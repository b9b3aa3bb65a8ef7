// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 3
// timeout: 600

// Bodies of finite elements whose nodes are material points: fix mpm/elements, create_points mesh.

#include "elements/fix_mpm_elements.h"
#include "elements/thin_testing.h"

using namespace MPM_TEST;

struct Kind {
  int dim;
  bool simplices;
  const char *options;
  std::string name() const
  {
    return strprintf("%dd %s%s", dim, simplices ? "simplices" : "cubes", options);
  }
};
const Kind kinds[] = {{2, true, ""}, {2, false, ""}, {2, false, " locking fbar"},
                      {3, true, ""}, {3, false, ""}, {3, false, " locking fbar"}};

/** A box of 4 x 3 (x 3) cells of size 1 from 2 2 2 on, in a periodic box. */
static std::string block(const Kind &kind, const std::string &file,
                         const std::string &fix_options = "")
{
  return MPM_TEST::box(kind.dim, "lj", "p p p", "0 10 0 10 0 10") + "fix g all mpm 1.0 " +
      fix_options + "\ncreate_points 1 mesh " + file + " scale 1.0 move 2 2 " +
      (kind.dim == 2 ? "" : "2") +
      "\nfix m all mpm/material density 2 neohookean 30 0.3\nfix e all mpm/elements " + file +
      kind.options + "\nthermo_style custom step\ntimestep 0.001\n";
}

static std::string block_mesh(const Kind &kind, double skew = 0.15)
{
  const int n[3] = {4, 3, 3};
  const double l[3] = {4.0, 3.0, 3.0};
  return box_mesh(kind.dim, n, l, kind.simplices, skew);
}

static FixMPMElements *elements(Scene &run)
{
  return run.fix<FixMPMElements>("e");
}

/** Positions F X + shift of the present ones. */
static void deform(Scene &run, const double F[3][3])
{
  for (int i = 0; i < run.n(); i++) {
    double *x = run.x()[i],
           X[3] = {x[0] - 4.0, x[1] - 3.5, x[2] - (run.lmp->domain->dimension - 2) * 3.5};
    for (int d = 0; d < run.lmp->domain->dimension; d++)
      x[d] += F[d][0] * X[0] + F[d][1] * X[1] + F[d][2] * X[2] - X[d];
  }
}

/** Positions of all points by ID. */
static std::vector<std::array<double, 3>> positions(Scene &run)
{
  const auto all = run.gather();
  std::vector<std::array<double, 3>> X(all.size() + 1);
  for (const auto &s : all) X[(int) s.tag] = {s.x[0], s.x[1], s.x[2]};
  return X;
}

// Volume, mass, and patch test: with an affine deformation forces on inner nodes vanish on an
// irregular mesh; each node has F, and stress and stored energy of the law
TEST(Elements, Patch)
{
  for (const auto &kind : kinds) {
    SCOPED_TRACE(kind.name());
    ScratchFile file("patch.msh", block_mesh(kind));
    Scene run(block(kind, file.name));
    run.commands("run 0\n");
    double mass = 0.0;
    const auto reference = positions(run);
    for (int i = 0; i < run.n(); i++) mass += run.mass()[i];
    EXPECT_NEAR(sum_over_ranks(mass), kind.dim == 2 ? 24.0 : 72.0, 1e-11);

    const double angle = 0.4, c = cos(angle), s = sin(angle);
    const double U[3][3] = {
        {1.1, 0.05, 0.0}, {0.05, 0.92, 0.0}, {0.0, 0.0, kind.dim == 3 ? 1.07 : 1.0}};
    double F[3][3];
    for (int k = 0; k < 3; k++) {
      F[0][k] = c * U[0][k] - s * U[1][k];
      F[1][k] = s * U[0][k] + c * U[1][k];
      F[2][k] = U[2][k];
    }
    deform(run, F);
    run.commands("run 0\n");
    const double J = F[2][2] * (F[0][0] * F[1][1] - F[0][1] * F[1][0]);
    const double mu = 30.0 / 2.6, lambda = 30.0 * 0.3 / (1.3 * 0.4);
    for (const auto &state : run.gather())
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) EXPECT_NEAR(state.F[3 * a + b], F[a][b], 1e-12);
    double trace = 0.0, total[3] = {0.0, 0.0, 0.0};
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) trace += F[a][b] * F[a][b];
    for (int i = 0; i < run.n(); i++) {
      const double *X = reference[run.lmp->atom->tag[i]].data(),
                   *f = elements(run)->forces() + 3 * i;
      bool inner = true;
      for (int d = 0; d < kind.dim; d++)
        inner = inner && X[d] > 2.01 && X[d] < (d == 0 ? 5.99 : 4.99);
      for (int d = 0; d < 3; d++) {
        total[d] += f[d];
        if (inner) EXPECT_NEAR(f[d], 0.0, 1e-12);
      }
    }
    for (int d = 0; d < 3; d++) EXPECT_NEAR(sum_over_ranks(total[d]), 0.0, 1e-12);
    const double energy = 0.5 * mu * (trace - 3.0 - 2.0 * log(J)) + 0.5 * lambda * log(J) * log(J);
    EXPECT_NEAR(sum_over_ranks(elements(run)->stored_energy()),
                energy * (kind.dim == 2 ? 12.0 : 36.0), 1e-11);
    for (const auto &state : run.gather()) {
      // tau = mu (b - 1) + lambda ln J
      double xx = 0.0, xy = 0.0;
      for (int k = 0; k < 3; k++) {
        xx += F[0][k] * F[0][k];
        xy += F[0][k] * F[1][k];
      }
      EXPECT_NEAR(J * state.stress[0], mu * (xx - 1.0) + lambda * log(J), 1e-11);
      EXPECT_NEAR(J * state.stress[3], mu * xy, 1e-11);
    }
  }
}

// A square between two planes of symmetry, pulled at its other sides, on lattices with cells as
// large as its elements, half of that, and less. Regions hold the nodes of elements in their
// surfaces as faces of the box do. Nodes of the lattice inside, one by one, let them creep:
// stresses were twice as large with coarse cells, and none with fine ones
SERIAL_TEST(Elements, RegionsHoldThemAsFacesDo)
{
  const double pull = 0.01, E = 1000.0, nu = 0.3;
  const int n[3] = {4, 4, 0};
  const double l[3] = {1.0, 1.0, 0.0};
  const ScratchFile mesh("square.msh", box_mesh(2, n, l, false, 0.15));
  for (const std::string grid :
       {"0.25 transfer flip 1.0", "0.125 transfer flip 1.0", "0.1 transfer flip 1.0 scheme musl",
        "0.1 transfer apic", "0.1 transfer flip 1.0 frame total"})
    for (const bool faces : {true, false}) {
      SCOPED_TRACE(grid + (faces ? " faces" : " regions"));
      Scene run(
          plane("lj", "f f", faces ? "0 2 0 2" : "-1 2 -1 2", 1, 0.2) + "fix grid all mpm " + grid +
          "\ncreate_points 1 mesh " + mesh.name +
          strprintf("\nfix m all mpm/material density 1 linear %g %g\n", E, nu) +
          "fix e all mpm/elements " + mesh.name + "\n" +
          (faces ? "fix left all mpm/boundary xlo slip\nfix low all mpm/boundary ylo slip\n"
                 : "region left block -9 0 -9 9 INF INF\nregion low block -9 9 -9 0 INF INF\n"
                   "fix left all mpm/boundary region left slip\nfix low all mpm/boundary region "
                   "low slip\n") +
          "region right block 0.99 2 -9 9 INF INF\ngroup right region right\n" +
          strprintf("variable fx atom %g*gmask(right)*(1-0.5*((y<0.1)||(y>0.9)))-60*mass*vx\n",
                    pull * l[1] / n[1]) +
          "variable fy atom -60*mass*vy\nfix pull all addforce v_fx v_fy 0\n"
          "fix dt all mpm/dt 0.5\nrun 800\n");
      double bent = 0.0, off = 0.0;
      for (const auto &s : run.gather()) {
        bent = std::max(bent, std::fabs(s.stress[0] - pull));
        // nodes are numbered row by row
        const int node = (int) s.tag - 1, i = node % 5, j = node / 5;
        if (i == 0) off = std::max(off, std::fabs(s.x[0]));
        if (j == 0) off = std::max(off, std::fabs(s.x[1]));
        if (i == 4) EXPECT_NEAR(s.x[0] - 1.0, pull * (1.0 - nu * nu) / E, 6e-5 * pull / E);
      }
      EXPECT_LT(measured("error of the stress, of the pull", bent / pull), 2e-5);
      EXPECT_LT(off, 1e-12);
      EXPECT_NEAR(run.evaluate("f_left[1]"), pull, 1e-8 * pull);
    }
}

// Nodes of elements are farther apart than nodes of the lattice: they hold together
SERIAL_TEST(Elements, DoNotComeApart)
{
  const int n[3] = {4, 4, 0};
  const double l[3] = {1.0, 1.0, 0.0};
  const ScratchFile mesh("apart.msh", box_mesh(2, n, l, false, 0.0));
  const std::string points = plane("lj", "f f", "-1 2 -1 2", 1, 0.2) +
      "fix grid all mpm 0.2\ncreate_points 1 mesh " + mesh.name +
      "\nfix m all mpm/material density 1 linear 1000 0.3\n",
                    pulled = "variable v atom 0.5*x\nvelocity all set v_v 0 0\n"
                             "fix dt all mpm/dt 0.5\nrun 8\n";
  const std::string elements = "fix e all mpm/elements " + mesh.name + "\n";
  EXPECT_EQ(lines_that_say(points + pulled, "comes apart").size(), 1u);
  EXPECT_EQ(lines_that_say(points + elements + pulled, "comes apart").size(), 0u);
}

// forces are minus the gradient of the stored energy, and do not change with a rotation of the body
TEST(Elements, ForcesAreTheGradientOfEnergy)
{
  for (const auto &kind : kinds) {
    SCOPED_TRACE(kind.name());
    ScratchFile file("gradient.msh", block_mesh(kind));
    const auto displace = [&](Scene &run, double shift) {    // large, not affine, all nodes
      for (int i = 0; i < run.n(); i++) {
        const double t = run.lmp->atom->tag[i];
        for (int d = 0; d < kind.dim; d++)
          run.x()[i][d] += 0.12 * sin(1.7 * t + 2.1 * d) + shift * cos(2.3 * t + 0.7 * d);
      }
    };
    double energy[2], work = 0.0;
    for (int side = 0; side < 2; side++) {
      Scene run(block(kind, file.name));
      displace(run, side ? 1e-5 : -1e-5);
      run.commands("run 0\n");
      energy[side] = sum_over_ranks(elements(run)->stored_energy());
    }
    const auto square = [&](Scene &run) {    // of all forces
      double sum = 0.0;
      for (int i = 0; i < run.n(); i++)
        for (int d = 0; d < kind.dim; d++) sum += pow(elements(run)->forces()[3 * i + d], 2);
      return sum_over_ranks(sum);
    };
    Scene run(block(kind, file.name));
    displace(run, 0.0);
    run.commands("run 0\n");
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < kind.dim; d++)
        work += elements(run)->forces()[3 * i + d] * cos(2.3 * run.lmp->atom->tag[i] + 0.7 * d);
    EXPECT_NEAR(sum_over_ranks(work) / ((energy[0] - energy[1]) / 2e-5), 1.0, 3e-7);

    // turned by a finite angle
    const double turn[3][3] = {
        {cos(2.0), -sin(2.0), 0.0}, {sin(2.0), cos(2.0), 0.0}, {0.0, 0.0, 1.0}};
    Scene turned(block(kind, file.name));
    displace(turned, 0.0);
    deform(turned, turn);
    turned.commands("run 0\n");
    EXPECT_NEAR(square(turned) / square(run), 1.0, 1e-12);
  }
}

// free flight through cells and periodic faces: nothing happens to the body
SERIAL_TEST(Elements, FreeFlight)
{
  for (const auto &kind : kinds)
    for (const char *transfer : {"", "transfer flip 1.0"}) {
      SCOPED_TRACE(kind.name() + " " + transfer);
      ScratchFile file("flight.msh", block_mesh(kind));
      Scene run(block(kind, file.name, transfer));
      run.commands(std::string("velocity all set 3.1 -2.3 ") + (kind.dim == 3 ? "1.7" : "0") +
                   "\ntimestep 0.02\ncompute e all mpm/energy\nthermo_style custom step c_e[2]\n"
                   "run 200\n");
      for (const auto &s : run.gather()) {
        EXPECT_NEAR(s.v[0], 3.1, 1e-12);
        EXPECT_NEAR(s.v[1], -2.3, 1e-12);
        EXPECT_NEAR(s.v[2], kind.dim == 3 ? 1.7 : 0.0, 1e-12);
      }
      EXPECT_NEAR(run.evaluate("c_e[2]"), 0.0, 1e-12);
      EXPECT_NEAR(run.evaluate("c_e[11]"), 0.0, 1e-10);
    }
}

// a spinning elastic block keeps momentum, and angular momentum and energy nearly; the ledger
// closes, and its integration entry decreases with the time step
SERIAL_TEST(Elements, Spin)
{
  for (const char *locking : {"", " locking fbar"}) {
    const Kind kind = {2, false, locking};
    ScratchFile file("spin.msh", block_mesh(kind));
    double integration[2];
    for (int fine = 0; fine < 2; fine++) {
      Scene run(block(kind, file.name, "transfer flip 1.0"));
      run.commands(strprintf(R"(
variable vx atom -0.8*(y-3.5)
variable vy atom 0.8*(x-4)
velocity all set v_vx v_vy 0
variable l atom mass*((x-4)*vy-(y-3.5)*vx)
compute l all reduce sum v_l
compute e all mpm/energy
thermo_style custom step c_l c_e c_e[*]
timestep %g
run 0
)",
                             fine ? 0.002 : 0.008));
      const double L = run.evaluate("c_l"), E = run.evaluate("c_e");
      run.commands(fine ? "run 2000\n" : "run 500\n");
      EXPECT_NEAR(measured("angular momentum", run.evaluate("c_l") / L), 1.0, 0.01);
      EXPECT_NEAR(measured("energy", run.evaluate("c_e") / E), 1.0, 0.02);
      EXPECT_GT(measured("stored", run.evaluate("c_e[2]") / E), 1e-3);
      EXPECT_NEAR(run.evaluate("c_e[6]") / E, 0.0, 1e-12);    // external work: there is none
      EXPECT_NEAR(run.evaluate("c_e[11]") / E, 0.0, 1e-12);
      integration[fine] = std::fabs(measured("integration", run.evaluate("c_e[10]") / E));
      double p[2] = {0.0, 0.0};
      for (const auto &s : run.gather())
        for (int d = 0; d < 2; d++) p[d] += s.mass * s.v[d];
      EXPECT_NEAR(p[0], 0.0, 1e-11);
      EXPECT_NEAR(p[1], 0.0, 1e-11);
    }
    EXPECT_LT(integration[1], 0.4 * integration[0]);
  }
}

// D2: cantilever 4 m x 1 m, plane strain, gravity 10 applied suddenly. Finite elements of the same
// kind without a lattice (quadrangles): the lower corner goes down by 3.2958 with 40 x 10, by
// 3.3027 with 80 x 20 elements, at t = 1.048
static double beam(int ny, double h, bool simplices, const char *locking, double &t_lowest)
{
  const int n[2] = {4 * ny, ny};
  const double l[2] = {4.0, 1.0};
  ScratchFile file("beam.msh", box_mesh(2, n, l, simplices, 0.0));
  Scene run(plane("si", "f f", "0 6 -6 2", 1, 0.3 * h) +
            strprintf(R"(
fix grid all mpm %g transfer flip 1.0
create_points 1 mesh %s
fix m all mpm/material density 1050 neohookean 1e6 0.3
fix e all mpm/elements %s%s

fix clamp all mpm/boundary xlo stick
fix g all gravity 10 vector 0 -1 0
fix step all mpm/dt 0.5
variable t equal time
fix end all halt 10 v_t > 1.15 error continue
)",
                      h, file.name.c_str(), file.name.c_str(), locking));
  double lowest = 0.0;
  const int corner = n[0] + 1;    // the ID of the node at 4 0
  run.each_step([&](double **) {
    double mine = 0.0, all;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->tag[i] == corner) mine = run.x()[i][1];
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
    if (all < lowest) {
      lowest = all;
      t_lowest = run.time();
    }
  });
  run.commands("run 100000\n");
  return lowest;
}

SERIAL_TEST(Elements, Cantilever)
{
  double t;
  EXPECT_NEAR(measured("quadrangles 1/10, lattice 1/20, lowest", beam(10, 0.05, false, "", t)),
              -3.2958, 3e-4);
  EXPECT_NEAR(measured("at", t), 1.048, 2e-3);
  EXPECT_NEAR(measured("quadrangles 1/10, lattice 1/10, lowest", beam(10, 0.1, false, "", t)),
              -3.2958, 2e-3);
  const double coarse = beam(5, 0.2, false, "", t);
  EXPECT_NEAR(measured("quadrangles 1/5, lowest", coarse), -3.30, 0.05);
  EXPECT_NEAR(measured("quadrangles 1/5, F-bar, lowest", beam(5, 0.2, false, " locking fbar", t)),
              -3.30, 0.05);
  // triangles are stiff in bending
  const double few = measured("triangles 1/5, lowest", beam(5, 0.2, true, "", t));
  const double more = measured("triangles 1/10, lowest", beam(10, 0.1, true, "", t));
  EXPECT_GT(few, more);
  EXPECT_NEAR((-3.305 - more) / (-3.305 - few), 0.25, 0.08);
}

// nodes in contact with grains have the width of their volume, unless told otherwise
TEST(Elements, Diameter)
{
  for (const auto &kind : kinds) {
    ScratchFile file("radii.msh", block_mesh(kind));
    const std::string scene =
        replaced(block(kind, file.name), "atom_style mpm", "atom_style hybrid sphere mpm");
    Scene run(scene.substr(0, scene.find("fix m all")));
    const auto *atom = run.lmp->atom;
    for (int i = 0; i < run.n(); i++)
      EXPECT_NEAR(2.0 * atom->radius[i], std::pow(atom->vfrac[i], 1.0 / kind.dim), 1e-14);
  }
}

// a standing wave along a bar of hexahedra, 16 elements in a wave length. Elements of length l with
// lumped masses have omega = 2 c/l sin(k l/2). Forces reach the nodes through the lattice and back,
// with FLIP velocities move them in the same way; each way is an average over a B-spline of the
// variance h^2/4, so that omega is less by the factor exp(-k^2 h^2/4)
SERIAL_TEST(Elements, Vibration)
{
  const int n[3] = {16, 2, 2};
  const double l[3] = {16.0, 2.0, 2.0};
  for (const double h : {1.0, 0.5}) {
    ScratchFile file("bar.msh", box_mesh(3, n, l, false, 0.0));
    Scene run(space("lj", "f f f", "0 16 0 2 0 2") +
              strprintf(R"(
fix g all mpm %g transfer flip 1.0
create_points 1 mesh %s scale 0.9999999
fix m all mpm/material density 1 linear 10 0
fix e all mpm/elements %s
fix w all mpm/boundary xlo xhi stick
fix s all mpm/boundary ylo yhi zlo zhi slip
variable v atom 0.001*sin(PI*x/8)
velocity all set v_v 0 0
variable q atom mass*vx*sin(PI*x/8)
compute q all reduce sum v_q
thermo_style custom step c_q
timestep 0.01
)",
                        h, file.name.c_str(), file.name.c_str()));
    run.commands("run 0\n");
    double last = run.evaluate("c_q"), t = 0.0, period = 0.0;
    int crossings = 0;
    const double expected = 2.0 * M_PI / (2.0 * sqrt(10.0) * sin(M_PI / 16.0));
    for (int k = 0; k < 400 && crossings < 2; k++) {
      run.commands("run 2 pre no post no\n");
      t += 0.02;
      const double now = run.evaluate("c_q");
      if (last * now < 0.0 && crossings++ == 1)
        period = 4.0 / 3.0 * (t - 0.02 * now / (now - last));
      last = now;
    }
    const double lattice = exp(0.25 * h * h * M_PI * M_PI / 64.0);
    EXPECT_NEAR(measured("period over that of the elements", period / expected), lattice, 3e-3);
  }
}

// a disk of triangles meets one of material points: momentum, energy, and what two of points do
SERIAL_TEST(Elements, Impact)
{
  double rebound[2];
  for (const bool mesh : {false, true}) {
    ScratchFile file("disk.msh", rings_of_triangles(6, 3.0).text());
    Scene run(plane("lj", "f f", "-10 10 -6 6", 2) +
              "region left cylinder z -3.5 0.1 3 INF INF\n"
              "region right cylinder z 3.5 -0.1 3 INF INF\n"
              "group left type 1\ngroup right type 2\n"
              "fix a left mpm 0.5 transfer flip 1.0\nfix b right mpm 0.5 transfer flip 1.0\n");
    run.commands(mesh ? "create_points 1 mesh " + file.name + " move -3.5 0.1\n"
                      : std::string("create_points 1 region left ppc 2\n"));
    run.commands(R"(
create_points 2 region right ppc 2
group left type 1
group right type 2
fix m all mpm/material density 1 neohookean 10 0.3
fix c all mpm/contact a b
velocity left set 0.15 0 0
velocity right set -0.15 0 0
compute e all mpm/energy
variable x equal vcm(right,x)-vcm(left,x)
variable p equal mass(left)*vcm(left,x)+mass(right)*vcm(right,x)
variable q equal mass(left)*vcm(left,y)+mass(right)*vcm(right,y)
thermo_style custom step v_x v_p v_q c_e c_e[*]
timestep 0.01
)");
    if (mesh) run.commands("fix e left mpm/elements " + file.name + "\n");
    run.commands("run 0\n");
    const double p = run.evaluate("v_p"), E = run.evaluate("c_e");
    run.commands("run 2000\n");
    rebound[mesh] = measured(mesh ? "restitution, mesh on points" : "restitution, points on points",
                             run.evaluate("v_x") / 0.3);
    EXPECT_NEAR(run.evaluate("v_p"), p, 1e-12);
    EXPECT_NEAR(run.evaluate("v_q"), 0.0, 1e-12);
    EXPECT_LT(run.evaluate("c_e"), E);
    EXPECT_NEAR(run.evaluate("c_e[6]") / E, 0.0, 1e-12);
    EXPECT_NEAR(run.evaluate("c_e[11]") / E, 0.0, 1e-12);
  }
  EXPECT_LT(rebound[1], 1.0);
  EXPECT_GT(rebound[1], 0.7);
  EXPECT_NEAR(rebound[1], rebound[0], 0.1);
}

// A body too heavy to be stopped is sheared: past yield, the shear stress rises with the plastic
// strain of all steps before, t = (s_y + H e)/sqrt(3) with e = (g - t/G)/sqrt(3). The heat of a
// step is its own plastic work, and nothing of the step before.
TEST(Elements, HardeningIsRemembered)
{
  const double G = 10.0, sy = 0.05, H = 3.0, g = 0.1;
  const double expected = (sy / sqrt(3.0) + H * g / 3.0) / (1.0 + H / (3.0 * G));
  for (const auto &kind : kinds)
    for (const bool up : {false, true}) {    // along x with y, and along z with x
      if (up && kind.dim == 2) continue;
      SCOPED_TRACE(kind.name());
      ScratchFile file("sheared.msh", block_mesh(kind), MPI_COMM_SELF);
      if (nranks() > 1) GTEST_SKIP() << "on one rank only";
      Scene run(replaced(
          replaced(
              block(kind, file.name), "neohookean 30 0.3",
              strprintf("eos linear 30 strength j2 %g %g hardening linear %g thermal adiabatic "
                        "1 300 0.9",
                        G, sy, H)),
          "density 2 ", "density 2e8 "));
      run.commands("compute e all mpm/energy\nthermo_style custom step c_e[*]\n");
      run.set_velocity([&](const double *x, double *v) {
        v[up ? 2 : 0] = g * (up ? x[0] - 4.0 : x[1] - 3.5);
      });
      run.commands("timestep 0.01\nrun 100\n");
      for (const auto &s : run.gather())
        EXPECT_NEAR(s.stress[up ? 4 : 3], expected, 5e-4 * expected);
      EXPECT_EQ(run.evaluate("c_e[4]"), 0.0);
      EXPECT_NEAR(run.evaluate("c_e[5]"), 0.9 * run.evaluate("c_e[3]"),
                  1e-12 * run.evaluate("c_e[3]"));
      EXPECT_GT(run.evaluate("c_e[3]"), 0.0);
    }
}

TEST(Elements, RanksAndRestart)
{
  for (const auto &kind : {kinds[0], kinds[2], kinds[3], kinds[4]}) {
    SCOPED_TRACE(kind.name());
    ScratchFile file("ranks.msh", block_mesh(kind));
    // tight communication, plastic, so that history matters
    std::string start =
        replaced(block(kind, file.name, kind.dim == 2 ? "transfer flip 0.99" : ""),
                 "neohookean 30 0.3", "eos linear 30 strength j2 10 0.5 hardening linear 3");
    // as fix mpm/surface lists has it
    if (kind.dim == 3)
      start = replaced(start, "fix g all mpm",
                       "neighbor 0.3 multi\ncomm_modify mode multi vel yes\nfix g all mpm");
    const std::string motion =
        "variable vx atom 1.5*sin(0.6*x)+1.0\nvariable vy atom -0.8*sin(0.5*y)\n"
        "velocity all set v_vx v_vy 0\ntimestep 0.01\n";
    ScratchFile own("serial.msh", block_mesh(kind));
    Scene serial(replaced(start, file.name, own.name) + motion + "run 300\n", MPI_COMM_SELF);
    Continued run(start + motion, 150, lines_again(start + motion), 150);
    const auto state = run.whole.gather();
    EXPECT_LT(measured("ranks", difference(serial.gather(), state)), 1e-11);
    double strain = 0.0;
    for (const auto &s : state) strain = std::max(strain, std::fabs(s.F[0] - 1.0));
    EXPECT_GT(strain, 0.05);
    EXPECT_TRUE(identical(state, run.again.gather()));
  }
}

SERIAL_TEST(Elements, TimeStepAndErrors)
{
  const Kind kind = {2, true, ""};
  ScratchFile file("errors.msh", block_mesh(kind, 0.0));
  {
    Scene run(block(kind, file.name));
    run.commands("fix dt all mpm/dt 1.0\nrun 0\n");
    // c^2 = (lambda + 2 mu)/rho; right triangles with two edges of 1: 2/sqrt(3 * 3) c
    const double c = sqrt((30.0 * 0.3 / (1.3 * 0.4) + 30.0 / 1.3) / 2.0);
    EXPECT_NEAR(run.lmp->update->dt * c, 2.0 / 3.0, 1e-12);
  }
  {
    Scene run(block(kind, file.name) + "timestep 0.2\n");
    EXPECT_THAT(run.error("run 1"), HasSubstr("is above the limit"));
  }
  const auto failure = [&](const std::string &from, const std::string &to) {
    Scene run;
    return run.error(replaced(block(kind, file.name), from, to) + "run 0\n");
  };
  EXPECT_THAT(failure("fix e all mpm/elements",
                      "create_points 1 box spacing 3 overlap yes\nfix e all mpm/elements"),
              HasSubstr("the mesh has 20 nodes"));
  EXPECT_THAT(failure("fix m all", "fix m2 all mpm/material density 1 neohookean 1 0.3 #"), "");
  EXPECT_THAT(failure("fix g all mpm 1.0", "fix g all mpm 1.0 locking fbar"),
              HasSubstr("use fix mpm/elements e locking fbar"));
  EXPECT_THAT(failure("fix g all mpm 1.0", "fix g all mpm 1.0 bad delete"),
              HasSubstr("must not be deleted"));
  EXPECT_THAT(failure("scale 1.0", "scale 2.0 #"), "");
  EXPECT_THAT(failure("scale 1.0", "scale 4.0 #"), HasSubstr("would overlap itself"));
  EXPECT_THAT(failure("move 2", "move 8"), "");    // across a periodic face
  EXPECT_THAT(failure("move 2", "move 30"), HasSubstr("20 nodes"));
  EXPECT_THAT(failure("fix e all", "fix first all mpm/elements " + file.name + "\nfix e all"),
              HasSubstr("first and e have points in common"));
  EXPECT_THAT(failure("scale 1.0", "colour 4.0 #"),
              HasSubstr("Unknown create_points mesh keyword"));
  EXPECT_THAT(failure("scale 1.0", "part skin #"), HasSubstr("no physical group 'skin'"));
  EXPECT_THAT(failure("mpm/elements " + file.name, "mpm/elements " + file.name + " locking fbar"),
              HasSubstr("is for quadrangles and hexahedra"));
  EXPECT_THAT(failure("mpm/elements " + file.name, "mpm/elements none.msh"),
              HasSubstr("cannot open"));
  {
    Scene run(block(kind, file.name) + "run 0\n");
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->tag[i] == 7) run.x()[i][0] += 1.5;
    EXPECT_THAT(run.error("run 0\n"), HasSubstr("deformation gradient of determinant"));
  }
}

// The fix mpm/material of the definition may be gone when elements ask for it.
TEST(Elements, MaterialIsDefinedAgain)
{
  const ScratchFile file("again.msh", block_mesh(kinds[1]));
  const std::string law = "fix m all mpm/material density 2 neohookean 30 0.3\n";
  const std::string start = block(kinds[1], file.name) + "velocity all set 0.3 0 0\nrun 20\n";
  Scene whole(start + "run 20\n"), again(start + "unfix m\n" + law + "run 20\n");
  EXPECT_TRUE(identical(whole.gather(), again.gather()));
  expect_refused(start + "unfix m\n",
                 {{"", "no material"},
                  {replaced(law, "neohookean 30 0.3", "eos linear 30 strength j2 10 1"),
                   "history variables none, but"}},
                 "run 1\n");
}
