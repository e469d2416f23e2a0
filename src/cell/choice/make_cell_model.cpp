#include "cell/choice/make_cell_model.h"

#include <optional>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/choice/member_change.h"
#include "cell/choice/model_choice.h"
#include "cell/family/family_cell.h"
#include "cell/model/online_cell.h"
#include "cell/model/puncturable_cell.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

constexpr char kNotOfFamily[] = "only a cell of a family can";

ChosenCellModel live(const Scene& scene, const OnlineCellModelConfig& config, const std::string& description,
                     bool as_required) {
  const auto cell = makeOnlineCell(scene);
  auto tracker = std::make_unique<OnlineCellModel>(cell, config);
  return {std::make_unique<PuncturableCell>(scene, std::move(tracker)), description + ": " + cell->description(),
          as_required, nullptr, std::string("this one is solved live; ") + kNotOfFamily};
}

ChosenCellModel unprepared(const Scene& scene, const OnlineCellModelConfig& config, const std::string& reason) {
  try {
    return live(scene, config, reason + "; so it is live", false);
  } catch (const ConfigError& error) {
    throw ConfigError(reason + "; and the live model cannot serve it: " + error.what());
  }
}

/// Why a scene's prepared data cannot be used, and what to do; `call` prepares them.
std::string notPreparedReason(const CacheRead<SurrogateData>& read, const std::string& call) {
  switch (read.state) {
    case CacheState::kDamaged:
      return "the prepared data are damaged (" + read.reason + "); to make them anew, run: " + call;
    case CacheState::kNotRegular:
      return "the prepared data are not used (" + read.reason + "); to make them, remove it and run: " + call;
    case CacheState::kUnreadable:
      return "the prepared data cannot be used (" + read.reason + "); make it readable, or remove it and run: " + call;
    case CacheState::kOther:
      return "the prepared data are not of this program and cell (" + read.reason + "); run: " + call;
    default:
      return "the cell is not prepared; run: " + call;
  }
}

/// Data of a scene's converged force.
struct PreparedCell {
  std::shared_ptr<const SurrogateData> data;  ///< none: `text` is the reason
  std::string text;                           ///< where they are from
  std::shared_ptr<const FamilyData> family;   ///< that contains the scene; null: none
};

/// The scene's own data or those of a family, whichever are more exact.
PreparedCell findPrepared(const Scene& scene, const std::string& families, const std::string& call) {
  const PreparationRange range = PreparationRange::standard(scene);
  auto own = SurrogateData::load(scene, range, preparedFile(scene, Preparation::plan(scene, range)));
  std::string outside;
  const std::optional<FamilyCell> member = findFamilyCell(families, scene, outside);
  const std::string damage = own || own.state == CacheState::kMissing ? "" : "; " + notPreparedReason(own, call);
  if (own && (!member || own.content->common_error <= member->data->common_error)) {
    return {std::make_shared<const SurrogateData>(std::move(*own.content)), "from its own preparation",
            member ? member->family : nullptr};
  }
  if (member) return {member->data, member->description + damage, member->family};
  return {nullptr, notPreparedReason(own, call) + (outside.empty() ? "" : "; " + outside), nullptr};
}

/// Reason why a scene cannot be prepared; empty when it can.
std::string preparationRefusal(const Scene& scene) {
  try {
    Preparation::check(scene);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

ChosenCellModel makeCellModel(const Scene& scene, const std::string& model, const CellModelConfig& config,
                              const std::string& path) {
  if (model == "explicit") {
    auto tracker = std::make_unique<ExplicitCellModel>(scene, config.explicit_dynamics);
    const std::string description =
        "the cell is the paper's explicit dynamics, as asked for: " + tracker->description();
    return {std::make_unique<PuncturableCell>(scene, std::move(tracker)), description, false, nullptr, kNotOfFamily};
  }
  if (scene.cell.tensegrity && model != "prepared") {
    return live(scene, config.online, "the cell is a tensegrity, solved live", true);  // its scene has no requirements
  }
  if (model == "live") return live(scene, config.online, "the cell is live, as asked for", true);
  const std::string refused = preparationRefusal(scene);
  if (!refused.empty()) {
    if (model == "prepared") throw ConfigError("model = prepared: " + refused);
    return unprepared(scene, config.online, "the cell cannot be prepared (" + refused + ")");
  }
  const std::string call = "rosrun cell_microinjection prepare --scene " + path;
  const PreparedCell prepared = findPrepared(scene, config.families, call);
  if (!prepared.data && model == "prepared") throw ConfigError("model = prepared: " + prepared.text);
  if (!prepared.data) return unprepared(scene, config.online, prepared.text);
  std::vector<ModelFigures> figures = {measurePreparedCell(scene, prepared.data)};
  std::string note;
  if (model != "prepared") {
    const CacheRead<ModelFigures> other = loadFigures(scene, "live");
    if (other) figures.push_back(*other.content);
    if (!other && other.state != CacheState::kMissing)
      note = "; figures of the live model: " + other.reason + "; run: " + call;
  }
  const ModelChoice choice = chooseModel(scene.requirements, figures);
  const std::string description = "model " + model + ": " + choice.reason + note;
  if (choice.name == "live") return live(scene, config.online, description + "; it is", choice.meets);
  auto tracker = std::make_unique<SurrogateCellModel>(scene, prepared.data);
  auto change = prepared.family ? std::make_unique<MemberChange>(scene, prepared.family, *tracker) : nullptr;
  return {std::make_unique<PuncturableCell>(scene, std::move(tracker)), description + "; " + prepared.text,
          choice.meets, std::move(change), kNotOfFamily};
}

}  // namespace microinjection
