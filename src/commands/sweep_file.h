#pragma once

#include <cstddef>
#include <string>

#include "cell/model/scene.h"
#include "cell/sweep/sweep_design.h"
#include "commands/indent_arguments.h"

namespace microinjection {

/// A sweep as its file describes it: a scene, keys that vary, and the indentation that each task
/// computes.
class SweepFile {
 public:
  /// Throws ConfigError that names file, key, value and what is allowed, also when no task's scene has
  /// the model of the indentation, or all would ignore an option of it.
  explicit SweepFile(const std::string& path);

  const SweepDesign& design() const { return design_; }
  std::vector<std::string> keys() const;
  /// The table's first columns, separated by commas: `task` and the keys; and those of a task's rows.
  std::string columns() const;
  std::string columns(std::size_t task) const;

  struct Task {
    Scene scene;
    IndentArguments indentation;
    std::string description;  ///< one line; equal for tasks with equal results, whatever their keys
  };
  /// Throws ConfigError that names the task when its scene is not valid.
  Task task(std::size_t number) const;

 private:
  void requireSomeTaskFits() const;

  std::string path_;
  YAML::Node scene_;
  SweepDesign design_;
  IndentArguments indentation_;  ///< without its scene
  std::string indentation_text_;
};

}  // namespace microinjection
