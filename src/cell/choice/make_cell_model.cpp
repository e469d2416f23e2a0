#include "cell/choice/make_cell_model.h"

#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/choice/model_choice.h"
#include "cell/family/family_cell.h"
#include "cell/model/live_cell.h"
#include "cell/model/puncturable_cell.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

/// Largest relative difference of the needle's force between a held cell and the glued one, of one homogeneous cell in
/// 20 cases: ./dev bench suction.
constexpr double kGluedError = 0.06;

/// Why a scene's own surrogate data cannot be used, and what to do; `call` prepares them.
std::string missingReason(const CacheRead<SurrogateData>& read, const std::string& call) {
  static const std::map<CacheState, std::pair<std::string, std::string>> kReasons = {
      {CacheState::kDamaged, {"are damaged", "to make them anew, run: "}},
      {CacheState::kNotRegular, {"are not used", "to make them, remove it and run: "}},
      {CacheState::kUnreadable, {"cannot be used", "make it readable, or remove it and run: "}},
      {CacheState::kOther, {"are not of this program and cell", "run: "}}};
  const auto known = kReasons.find(read.state);
  std::string reason = "the cell is not prepared; run: ";
  if (known != kReasons.end())
    reason = "the surrogate data " + known->second.first + " (" + read.reason + "); " + known->second.second;
  return reason + call;
}

/// The scene's own data or those of a family, whichever are more exact.
SurrogateSource findSurrogate(const Scene& scene, const std::string& families, const std::string& call) {
  const SurrogateRange range = SurrogateRange::standard(scene);
  auto own = SurrogateData::load(scene, range, surrogateFile(scene, SurrogatePlan::plan(scene, range)));
  std::string outside;
  const std::optional<FamilyCell> member = findFamilyCell(families, scene, outside);
  SurrogateSource source;
  if (member) source.family = member->family;
  if (own && (!member || own.content->common_error <= member->data->common_error)) {
    source.data = std::make_shared<const SurrogateData>(std::move(*own.content));
    source.text = "from its own preparation";
  } else if (member) {
    source.data = member->data;
    source.text =
        member->description + (own || own.state == CacheState::kMissing ? "" : "; " + missingReason(own, call));
  } else {
    source.text = missingReason(own, call) + (outside.empty() ? "" : "; " + outside);
  }
  return source;
}

/// Between surrogate data, where a scene has some, and the live cell.
ServingPlan planBetween(const Scene& scene, const std::string& model, const std::string& families,
                        const std::string& call) {
  ServingPlan plan;
  try {
    SurrogatePlan::check(scene);
  } catch (const ConfigError& error) {
    plan.source.text = std::string("the cell cannot be prepared (") + error.what() + ")";
  }
  if (plan.source.text.empty()) plan.source = findSurrogate(scene, families, call);
  if (plan.source.data) {
    std::vector<ModelFigures> figures = {measureSurrogate(scene, plan.source.data)};
    std::string note;
    if (model == "auto") {
      const CacheRead<ModelFigures> live = loadFigures(scene, "live");
      if (live) figures.push_back(*live.content);
      if (!live && live.state != CacheState::kMissing)
        note = "; figures of the live model: " + live.reason + "; run: " + call;
    }
    const ModelChoice choice = chooseModel(scene.requirements, figures);
    plan.served = choice.name == "live" ? Served::kLive : Served::kSurrogate;
    plan.as_required = choice.meets;
    plan.reason = "model " + model + ": " + choice.reason + note + "; " +
                  (plan.served == Served::kLive ? "it is" : plan.source.text);
  } else {
    if (model == "surrogate") throw ConfigError("model = surrogate: " + plan.source.text);
    plan.is_fallback = true;
    plan.as_required = false;
    plan.reason = plan.source.text + "; so it is live";
  }
  return plan;
}

}  // namespace

ServingPlan planServing(const Scene& wanted, const std::string& model, const std::string& families,
                        const std::string& call) {
  ServingPlan plan;
  const Scene scene = wanted.glued();
  if (model == "explicit") {
    plan.served = Served::kExplicit;
    plan.reason = "the cell is the paper's explicit dynamics, as asked for";
    plan.as_required = false;
  } else if (model == "live") {
    plan.reason = "the cell is live, as asked for";
  } else if (model == "auto" && scene.cell.tensegrity) {
    plan.reason = "the cell is a tensegrity, solved live";  // its scene has no requirements
  } else {
    plan = planBetween(scene, model, families, call);
  }
  plan.scene = std::make_shared<const Scene>(scene);
  if (wanted.holding_pipette.mouth) {
    plan.glued_error = kGluedError;
    plan.as_required = plan.as_required && kGluedError <= wanted.requirements.force_error;
    std::ostringstream note;
    note << "; suction holds the cell, which is served as glued to a ring of "
         << 1e6 * scene.holding_pipette.contact_radius << " um: its force is up to " << 100 * kGluedError
         << " % from that of the held cell";
    plan.reason += note.str();
  }
  return plan;
}

ChosenCellModel makeCellModel(const Scene& wanted, const std::string& model, const CellModelConfig& config,
                              const std::string& path) {
  ServingPlan plan = planServing(wanted, model, config.families, "rosrun cell_microinjection prepare --scene " + path);
  const Scene& scene = *plan.scene;
  ChosenCellModel chosen{nullptr, std::move(plan.reason), plan.as_required, nullptr, "only a cell of a family can"};
  std::unique_ptr<CellModel> tracker;
  if (plan.served == Served::kExplicit) {
    auto explicit_model = std::make_unique<ExplicitCellModel>(scene, config.explicit_dynamics);
    chosen.description += ": " + explicit_model->description();
    tracker = std::move(explicit_model);
  } else if (plan.served == Served::kSurrogate) {
    auto surrogate = std::make_unique<SurrogateCellModel>(scene, plan.source.data);
    if (plan.source.family) chosen.change = std::make_unique<MemberChange>(scene, plan.source.family, *surrogate);
    tracker = std::move(surrogate);
  } else {
    std::shared_ptr<const LiveCell> cell;
    try {
      cell = makeLiveCell(scene);
    } catch (const ConfigError& error) {
      if (!plan.is_fallback) throw;
      throw ConfigError(plan.source.text + "; and the live model cannot serve it: " + error.what());
    }
    chosen.description += ": " + cell->description();
    chosen.unchangeable = "this one is solved live; " + chosen.unchangeable;
    tracker = std::make_unique<LiveCellModel>(cell, config.live);
  }
  chosen.cell = std::make_unique<PuncturableCell>(scene, std::move(tracker));
  return chosen;
}

}  // namespace microinjection
