// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// The reader of Gmsh files.

#include "mesh/gmsh.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

#include <sstream>
#include <stdexcept>

using namespace MPM_NS;
using ::testing::HasSubstr;

Mesh read(const std::string &text)
{
  std::istringstream in(text);
  return read_gmsh(in, "test.msh");
}

std::string failure(const std::string &text)
{
  try {
    read(text);
  } catch (const std::runtime_error &e) {
    return e.what();
  }
  return "";
}

const std::string FORMAT_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string FORMAT_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";

// a square of a triangle pair and a quadrangle, with its boundary, and a node that nobody uses
const std::string FLAT = FORMAT_2 +
    "$PhysicalNames\n3\n1 7 \"rim\"\n2 5 \"left part\"\n2 6 \"right\"\n$EndPhysicalNames\n"
    "$Nodes\n7\n10 0 0 0\n11 1 0 0\n12 2 0 0\n13 0 1 0\n14 1 1 0\n15 2 1 0\n99 5 5 0\n$EndNodes\n"
    "$Elements\n5\n1 15 2 0 1 10\n2 1 2 7 1 10 11\n3 2 2 5 1 10 11 14\n4 2 2 5 1 10 13 14\n"
    "5 3 2 6 2 11 12 15 14\n$EndElements\n";

TEST(Mesh, Format22)
{
  Mesh mesh = read(FLAT);
  ASSERT_EQ(mesh.nodes.size(), 7u);
  ASSERT_EQ(mesh.elements.size(), 4u);
  EXPECT_EQ(mesh.elements[0].type, ElementType::LINE);
  Mesh rim = mesh;
  rim.keep(1, "rim");
  EXPECT_EQ(rim.elements.size(), 1u);
  EXPECT_EQ(rim.nodes.size(), 2u);
  mesh.elements.erase(mesh.elements.begin());
  for (const auto &e : mesh.elements) EXPECT_EQ(element_dimension(e.type), 2);
  EXPECT_EQ(mesh.groups.at({2, 5}), "left part");
  EXPECT_EQ(mesh.elements[2].type, ElementType::QUAD);
  EXPECT_EQ(mesh.elements[2].physical, 6);
  EXPECT_EQ(mesh.elements[2].label, 5);
  EXPECT_DOUBLE_EQ(mesh.size(mesh.elements[0]), 0.5);
  EXPECT_DOUBLE_EQ(mesh.size(mesh.elements[1]), -0.5);    // clockwise
  mesh.orient(2);
  double area = 0.0;
  for (const auto &e : mesh.elements) {
    EXPECT_GT(mesh.size(e), 0.0);
    area += mesh.size(e);
  }
  EXPECT_DOUBLE_EQ(area, 2.0);

  mesh.keep(2);
  EXPECT_EQ(mesh.nodes.size(), 6u);
  Mesh named = mesh, tagged = mesh;
  named.keep(2, "left part");
  EXPECT_EQ(named.elements.size(), 2u);
  ASSERT_EQ(named.nodes.size(), 4u);
  EXPECT_EQ(named.nodes[3], (std::array<double, 3>{1.0, 1.0, 0.0}));
  EXPECT_EQ(named.nodes[named.elements[0].node[2]][1], 1.0);
  tagged.keep(2, "6");
  EXPECT_EQ(tagged.elements.size(), 1u);
  EXPECT_EQ(tagged.nodes.size(), 4u);
  EXPECT_THROW(mesh.keep(2, "top"), std::runtime_error);
  EXPECT_THROW(mesh.keep(3), std::runtime_error);
}

// a cube as a hexahedron, a tetrahedron, and a quadrangle; two blocks of nodes, a section of data
TEST(Mesh, Format41)
{
  Mesh mesh =
      read(FORMAT_4 +
           "$PhysicalNames\n1\n3 2 \"solid\"\n$EndPhysicalNames\n$Entities\n1 1 1 2\n1 0 0 0 0\n"
           "1 0 0 0 1 0 0 0 2 1 -1\n1 0 0 0 1 1 0 1 4 1 1\n1 0 0 0 1 1 1 1 2 1 1\n"
           "2 0 0 0 1 1 1 0 0\n$EndEntities\n$Nodes\n2 9 1 20\n2 1 1 4\n1\n2\n3\n4\n0 0 0 0 0\n"
           "1 0 0 0 0\n1 1 0 0 0\n0 1 0 0 0\n3 1 0 5\n5\n6\n7\n8\n20\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
           "0 0 2\n$EndNodes\n$Elements\n3 3 1 3\n2 1 3 1\n1 1 2 3 4\n3 1 5 1\n2 5 6 7 8 1 2 3 4\n"
           "3 2 4 1\n3 5 6 8 20\n$EndElements\n$InterpolationScheme\n1 \"$x\" 3 4\n"
           "$EndInterpolationScheme\n");
  ASSERT_EQ(mesh.elements.size(), 3u);
  EXPECT_EQ(mesh.nodes.size(), 9u);
  EXPECT_EQ(element_dimension(mesh.elements[1].type), 3);
  EXPECT_EQ(mesh.elements[0].physical, 4);
  EXPECT_EQ(mesh.elements[1].physical, 2);
  EXPECT_EQ(mesh.elements[2].physical, 0);
  EXPECT_DOUBLE_EQ(mesh.size(mesh.elements[1]), -1.0);
  mesh.orient(3);
  EXPECT_DOUBLE_EQ(mesh.size(mesh.elements[1]), 1.0);
  EXPECT_DOUBLE_EQ(mesh.size(mesh.elements[2]), 1.0 / 6.0);
  mesh.keep(3, "solid");
  EXPECT_EQ(mesh.elements.size(), 1u);
  EXPECT_EQ(mesh.nodes.size(), 8u);
}

TEST(Mesh, Refused)
{
  EXPECT_THAT(failure("solid cube\n"), HasSubstr("not a mesh file of Gmsh"));
  EXPECT_THAT(failure("solid cube\n"), HasSubstr("Abaqus"));
  EXPECT_THAT(failure("$MeshFormat\n4 0 8\n$EndMeshFormat\n"), HasSubstr("2.2 or 4.1"));
  EXPECT_THAT(failure("$MeshFormat\n2.2 1 8\n"), HasSubstr("binary"));
  EXPECT_THAT(failure(FORMAT_2 + "$Nodes\n2\n1 0 0 0\n1 0 0 1\n"), HasSubstr("test.msh:7: node 1"));
  EXPECT_THAT(failure(FORMAT_2 + "$Nodes\n2\n1 0 0 0\n"), HasSubstr("ends too early"));
  EXPECT_THAT(failure(FORMAT_2 + "$Nodes\n1\n1 0 x 0\n"), HasSubstr("'x' is not a number"));
  const std::string nodes =
      FORMAT_2 + "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 0 1\n5 1 0 1\n6 1 1 1\n$EndNodes\n";
  EXPECT_THAT(failure(nodes), HasSubstr("no nodes or no elements"));
  EXPECT_THAT(failure(nodes + "$Elements\n1\n1 6 0 1 2 3 4 5 6\n$EndElements\n"),
              HasSubstr("prism"));
  EXPECT_THAT(failure(nodes + "$Elements\n1\n1 9 0 1 2 3 4 5 6\n"), HasSubstr("ElementOrder"));
  EXPECT_THAT(failure(nodes + "$Elements\n1\n8 2 0 1 2 9\n"),
              HasSubstr("element 8 has the node 9"));
  EXPECT_THAT(failure(nodes + "$Elements\n1\n8 2 0 1 2 2\n"), HasSubstr("twice"));
  EXPECT_THAT(failure(nodes + "$Elements\n1\n8 2 0 1 2 3\n$EndNodes\n"), HasSubstr("$EndElements"));
  EXPECT_THAT(failure(nodes + "$Elements\n2\n8 2 1 1 1 2 3\n9 2 1 2 3 1 2\n$EndElements\n"),
              HasSubstr("elements 8 and 9"));
  EXPECT_THROW(read_gmsh("no such file"), std::runtime_error);
}
