#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <vector>

namespace microinjection {

/// One case of `./dev bench peers`: a cell's mesh, its materials, the tip and the tip's motion, SI
/// units. doc/reference/peer_format.md defines the text.
struct PeerCase {
  struct Layer {
    std::string law;           ///< one of materialModels()
    double young_modulus = 0;  ///< Pa
    double poisson_ratio = 0;
  };
  struct Element {
    int layer = 0;           ///< 0 the outermost
    std::vector<int> nodes;  ///< corners, then midpoints
  };
  struct Tip {
    std::string shape = "disc";     ///< disc or hemisphere
    std::string mode = "sticking";  ///< sticking or sliding
    double radius = 0;              ///< m
    double height = 0;              ///< m, z of its lowest point at first contact
  };

  std::string scene;                   ///< path of the scene file that the case was made of
  int dimension = 3;                   ///< 3: tetrahedra; 2: triangles of the section, nodes are (r, z)
  int order = 1;                       ///< of the elements
  std::vector<Layer> layers;           ///< outermost first
  int vertices = 0;                    ///< nodes below are corners of elements
  std::vector<Eigen::Vector3d> nodes;  ///< m; of a section (r, z, 0)
  std::vector<Element> elements;
  std::vector<std::vector<int>> surface;  ///< facets of the outer surface, corners, then midpoints
  std::vector<int> held;                  ///< nodes that are fixed
  std::vector<int> glued;                 ///< nodes that move with the tip; none of a rounded tip
  Tip tip;
  std::vector<Eigen::Vector3d> motion;  ///< m, displacement of the tip since first contact, of each step

  int elementNodes() const { return order == 1 ? dimension + 1 : (dimension + 1) * (dimension + 2) / 2; }
  int facetNodes() const { return order == 1 ? dimension : dimension * (dimension + 1) / 2; }
};

/// std::runtime_error with the line when the text is no case.
PeerCase readPeerCase(std::istream& text);
PeerCase readPeerCase(const std::string& path);
std::string peerCaseText(const PeerCase& peer_case);

}  // namespace microinjection
