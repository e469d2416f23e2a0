#include "commands/sweep_file.h"

#include <filesystem>
#include <limits>
#include <vector>

#include "base/cache_file.h"
#include "base/config_reader.h"
#include "base/csv_field.h"
#include "base/errors.h"
#include "base/paths.h"
#include "cell/sweep/scene_variation.h"

namespace microinjection {
namespace {

constexpr auto kRequired = ConfigReader::kRequired;
constexpr char kFormat[] = "sweep 2";

void readIndentation(ConfigReader reader, IndentArguments& arguments) {
  Indenting& indenting = arguments.indenting;
  ConvergedForceConfig& converged = arguments.converged;
  reader.numbers("depths", indenting.depths, Range::nonNegative(), kRequired);
  reader.numbers("withdraw", indenting.withdrawal);
  reader.vector("lateral", indenting.lateral);
  if (reader.has("speed")) reader.number("speed", indenting.speed.emplace(), Range::positive());
  reader.number("hold", indenting.hold, Range::nonNegative());
  std::string model = "auto", element = "p2_p0";
  reader.choice("model", model, indentModels());
  reader.choice("element", element, elementNames());
  arguments.setModel(model);
  converged.element = elementKind(element);
  arguments.tolerance_given = reader.has("tolerance");
  reader.number("tolerance", converged.tolerance, Range::positive());
  reader.number("finest", converged.finest, Range::closed(1, 6));
  // A limit of time would make the result depend on the machine.
  converged.time = std::numeric_limits<double>::infinity();
}

std::string flow(const YAML::Node& node) {
  YAML::Emitter out;
  out << YAML::Flow << node;
  return out.c_str();
}

}  // namespace

SweepFile::SweepFile(const std::string& path) : path_(path) {
  ConfigReader reader = ConfigReader::ofFile(path);
  std::string scene;
  reader.text("scene", scene, kRequired);
  design_ = SweepDesign::read(reader);
  readIndentation(reader.section("indentation", kRequired), indentation_);
  reader.finish();
  scene_ = loadYamlMap(absolutePath(scene, std::filesystem::path(path).parent_path().string()));
  const YAML::Node indentation = reader.any("indentation");
  indentation_text_ = flow(indentation);
  indentation_.prefix = "indentation/";
  for (const auto& option : indentation) indentation_.given[option.first.Scalar()] = flow(option.second);
  requireSomeTaskFits();
}

/// The keys may vary whether a scene has the model, so one task that has it is enough. It is nearly always the first.
void SweepFile::requireSomeTaskFits() const {
  std::string first;
  for (std::size_t number = 0; number < design_.size(); ++number) {
    const Task each = task(number);
    try {
      return each.indentation.requireFit(each.scene);
    } catch (const ConfigError& error) {
      if (number == 0) first = error.what();
    }
  }
  throw ConfigError(path_ + ": " + first);
}

std::vector<std::string> SweepFile::keys() const {
  std::vector<std::string> names;
  for (const SweptKey& key : design_.keys()) names.push_back(key.key);
  return names;
}

std::string SweepFile::columns() const {
  std::string result = "task";
  for (const std::string& key : keys()) result += "," + csvField(key);
  return result;
}

std::string SweepFile::columns(std::size_t task) const {
  std::string result = std::to_string(task);
  for (const std::string& value : design_.values(task)) result += "," + csvField(value);
  return result;
}

SweepFile::Task SweepFile::task(std::size_t number) const {
  const std::string origin = path_ + ": task " + std::to_string(number);
  Task task;
  task.indentation = indentation_;
  try {
    const YAML::Node scene = varied(scene_, keys(), design_.values(number));
    task.scene = parseScene(scene, origin);
    task.description = std::string(kFormat) + " " + MICROINJECTION_VERSION + " task " + std::to_string(number) + " " +
                       contentHash(flow(scene) + indentation_text_);
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    throw ConfigError(message.rfind(origin, 0) == 0 ? message : origin + ": " + message);
  }
  if (!task.indentation.tolerance_given)
    task.indentation.converged.tolerance = defaultTolerance(task.scene, task.indentation);
  return task;
}

}  // namespace microinjection
