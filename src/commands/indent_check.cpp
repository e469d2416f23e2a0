#include "base/errors.h"
#include "base/plausible.h"
#include "commands/indent_arguments.h"

namespace microinjection {
namespace {

/// Collects errors that name an option as its user wrote it.
class Refusals {
 public:
  explicit Refusals(const IndentArguments& arguments) : arguments_(arguments) {}

  void add(const std::string& option, const std::string& message) {
    const auto text = arguments_.given.find(option);
    const std::string value = text == arguments_.given.end() ? "" : " = " + text->second;
    add(arguments_.prefix + option + value + ": " + message);
  }
  void add(const std::string& message) { errors_.push_back(message); }
  /// Throws ConfigError when there is any.
  void throwAny() const {
    if (!errors_.empty()) throw ConfigError(errors_);
  }

 private:
  const IndentArguments& arguments_;
  std::vector<std::string> errors_;
};

void checkMembrane(const Scene& scene, const IndentArguments& arguments, Refusals& refusals) {
  const Indenting& indenting = arguments.indenting;
  const std::string with = " with " + arguments.prefix + "model = membrane";
  scene.requireContinuum(arguments.prefix + "model = membrane");
  if (!scene.cell.biomembrane) refusals.add("cell/biomembrane is missing: thickness and dimple_radius, m");
  if (!scene.needle.offset.isZero(0)) refusals.add("needle/offset: must be 0" + with);
  if (!indenting.lateral.isZero(0)) refusals.add("lateral", "must be 0" + with);
  if (indenting.speed) refusals.add("speed", "must be left out" + with + ", which has no time");
  if (indenting.hold > 0) refusals.add("hold", "must be left out" + with + ", which has no time");
}

void checkTensegrity(const IndentArguments& arguments, Refusals& refusals) {
  for (const char* option : {"tolerance", "element", "time", "finest", "withdraw"}) {
    if (arguments.given.count(option) != 0)
      refusals.add(option, "must be left out for a scene of cell/model = tensegrity");
  }
}

/// Refuses an option with a value that is not in the range.
void require(const PlausibleRange& range, const std::string& option, double value, const std::string& because,
             Refusals& refusals) {
  if (!range.range.contains(value)) refusals.add(option, "must be " + range.allowed(value) + because);
}

void checkMotion(const Scene& scene, const Indenting& indenting, Refusals& refusals) {
  const double diameter = scene.cell.diameter();
  const PlausibleRange inside{"m", Range::closed(0, diameter)};
  const std::string why = " (the cell's diameter is the most)";
  for (const double depth : indenting.depths) {
    if (inside.range.contains(depth)) continue;
    require(inside, "depths", depth, why, refusals);
    break;
  }
  require(inside, "lateral", indenting.lateral.cwiseAbs().maxCoeff(), why, refusals);
  for (const double depth : indenting.withdrawal) {
    if (plausible::kDistance.range.contains(depth)) continue;
    require(plausible::kDistance, "withdraw", depth, "", refusals);
    break;
  }
  if (indenting.speed) require(plausible::kSpeed, "speed", *indenting.speed, "", refusals);
  require(plausible::kTime, "hold", indenting.hold, "", refusals);
}

}  // namespace

void IndentArguments::requireFit(const Scene& scene) const {
  const bool own_model = !membrane && (live || converged.model == ConvergedForceConfig::Model::kAuto);
  Refusals refusals(*this);
  checkMotion(scene, indenting, refusals);
  refusals.throwAny();
  if (membrane) checkMembrane(scene, *this, refusals);
  if (scene.cell.tensegrity && own_model) {
    checkTensegrity(*this, refusals);
  } else if (live || membrane) {
    const std::string model = live ? "live" : "membrane";
    if (!indenting.withdrawal.empty()) refusals.add("withdraw", "must be left out with " + prefix + "model = " + model);
  } else {
    ConvergedForce(scene, indenting, converged);  // which throws when it does not fit
  }
  refusals.throwAny();
}

}  // namespace microinjection
