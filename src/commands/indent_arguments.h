#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/model/converged_force.h"

namespace microinjection {

/// Command line of `indent`.
struct IndentArguments {
  std::string scene;  ///< file
  Indenting indenting;
  bool live = false;      ///< use the P1 tetrahedra of a live session instead of a converged solution
  bool membrane = false;  ///< use the scene's biomembrane instead
  ConvergedForceConfig converged;
  bool tolerance_given = false;
  std::vector<std::string> converged_options;  ///< given options that apply to a converged solution only
  std::string csv = "-";                       ///< file, or - for the standard output

  /// One of indentModels().
  void setModel(const std::string& name);
};

/// auto, axisymmetric, spatial, live and membrane; see --help of `indent`.
const std::vector<std::string>& indentModels();

/// Relative error of the force that is asked for where no other one is given.
double defaultTolerance(const Scene& scene, const IndentArguments& arguments);

/// Returns nothing after printing the help. Throws ConfigError, or an exception of
/// boost::program_options, on bad usage.
std::optional<IndentArguments> parseIndentArguments(int argc, char** argv);

}  // namespace microinjection
