#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// What a program computed of a PeerCase; doc/reference/peer_format.md defines the text.
struct PeerResult {
  struct Step {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the tip; nan: no solution
    double time = 0;                                  ///< s, processor time of the step
  };

  std::string program;   ///< with its version
  std::string model;     ///< how the program solves a step
  std::string element;   ///< p1, p2, p2_p0, ...
  std::string law;       ///< strain energy that was used: "same", or its name where the program lacks the case's
  std::string declined;  ///< why the program does not serve the case; empty when it does
  std::vector<Step> steps;
};

std::string peerResultText(const PeerResult& result);

}  // namespace microinjection
