#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cell/model/converged_force.h"

namespace microinjection {

/// What is to be computed: the command line of `indent`, or the indentation of a sweep file.
struct IndentArguments {
  std::string scene;  ///< file
  Indenting indenting;
  bool live = false;      ///< use the P1 tetrahedra of a live session instead of a converged solution
  bool membrane = false;  ///< use the scene's biomembrane instead
  ConvergedForceConfig converged;
  bool tolerance_given = false;
  std::map<std::string, std::string> given;  ///< texts of the options that the user gave, by name
  std::string prefix = "--";                 ///< of an option's name in messages
  std::string csv = "-";                     ///< file, or - for the standard output

  /// One of indentModels().
  void setModel(const std::string& name);
  /// Throws ConfigError when the scene does not have the model, or when the model would ignore an
  /// option that was given. Its message names each option with its value and what is allowed.
  void requireFit(const Scene& scene) const;
};

/// auto, axisymmetric, spatial, live and membrane; see --help of `indent`.
const std::vector<std::string>& indentModels();

/// Relative error of the force that is asked for where no other one is given.
double defaultTolerance(const Scene& scene, const IndentArguments& arguments);

/// Returns nothing after printing the help. Throws ConfigError, or an exception of
/// boost::program_options, on bad usage.
std::optional<IndentArguments> parseIndentArguments(int argc, char** argv);

}  // namespace microinjection
