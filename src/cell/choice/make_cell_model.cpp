#include "cell/choice/make_cell_model.h"

#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/choice/model_choice.h"
#include "cell/family/axis_force_ratio.h"
#include "cell/family/family_cell.h"
#include "cell/family/pierced_family.h"
#include "cell/family/tongue_family.h"
#include "cell/family/withdrawal_family.h"
#include "cell/model/bore_tongue.h"
#include "cell/model/live_cell.h"
#include "cell/model/puncturable_cell.h"
#include "cell/model/solved_branch.h"
#include "cell/model/withdrawn_cell.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

constexpr double kLostAtMost = 0.05;  ///< of the work, by friction on the way out (./dev bench friction)

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

std::optional<SurrogateSource> findRubbedCell(const Scene& scene, const std::string& families, std::string& outside) {
  if (!(scene.needle.contact.friction > 0)) return std::nullopt;
  const std::optional<AxisForceRatio> ratio = findFrictionForce(families, scene, outside);
  const std::optional<FamilyCell> member = ratio ? findFamilyCell(families, stuck(scene), outside) : std::nullopt;
  if (!member) return std::nullopt;
  if (!scene.needle.offset.isZero(0)) {
    outside = "the families know friction on the axis only";
    return std::nullopt;
  }
  auto data = std::make_shared<SurrogateData>(*member->data);
  ratio->applyTo(*data, scene.radius());
  data->common_error = std::hypot(data->common_error, ratio->error());
  data->median_error = std::hypot(data->median_error, ratio->error() / 2);
  std::ostringstream text;
  text.precision(2);
  text << member->description << "; corrected by up to " << 100 * ratio->largestChange()
       << " % for a tip that rubs, with an error of " << 100 * ratio->error()
       << " % on the axis; beside it the error is not known";
  SurrogateSource source;
  source.data = std::move(data);
  source.text = text.str();
  source.on_axis_only = true;
  return source;
}

}  // namespace

SurrogateSource findFamilySource(const Scene& scene, const std::string& families, std::string& outside) {
  if (const std::optional<FamilyCell> member = findFamilyCell(families, scene, outside))
    return {member->data, member->description, member->family, false};
  return findRubbedCell(scene, families, outside).value_or(SurrogateSource());
}

Scene withoutAdhesion(Scene scene) {
  scene.needle.contact.adhesion_energy = scene.needle.contact.adhesion_range = 0;
  return scene;
}

namespace {

/// The scene's own data or those of a family, whichever are more exact; of a needle that rubs its own ones, if it has
/// any.
SurrogateSource findSurrogate(const Scene& scene, const std::string& families, const std::string& call) {
  const SurrogateRange range = SurrogateRange::standard(scene);
  auto own = SurrogateData::load(scene, range, surrogateFile(scene, SurrogatePlan::plan(scene, range)));
  std::string outside;
  SurrogateSource source = findFamilySource(scene, families, outside);
  if (own && (!source.family || own.content->common_error <= source.data->common_error)) {
    source.data = std::make_shared<const SurrogateData>(std::move(*own.content));
    source.text = "from its own preparation";
    source.on_axis_only = false;
  } else if (source.data) {
    if (!own && own.state != CacheState::kMissing) source.text += "; " + missingReason(own, call);
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

/// What the scene's needle draws in, by the family of tongues that has it; else it is solved, which takes seconds.
std::optional<BoreTongue> tongueOf(const Scene& scene, const std::string& families) {
  constexpr int kPoints = 20;
  if (!scene.needle.bore_radius) return std::nullopt;
  const Scene mouth = boreMouth(scene);
  std::string refusal;
  const std::optional<FamilyTongue> family = findFamilyTongue(families, mouth, refusal);
  if (!family) return solveBoreTongue(scene);
  const double scale = mouth.radius() / *scene.needle.bore_radius;
  const DrawnTongue rest = family->at(0);
  std::vector<BoreTongue::Point> points;
  for (int i = 0; i <= kPoints; ++i) {
    const double suction = family->strongest() * i / kPoints;
    const DrawnTongue tongue = family->at(suction);
    points.push_back(
        {suction, scale * (tongue.length - rest.length), scale * scale * scale * (tongue.volume - rest.volume)});
  }
  return BoreTongue(points);
}

/// What suction changes of the planned force: surrogate data for a needle on the axis are corrected, where a family of
/// held forces has the cell.
void tellOfSuction(const Scene& wanted, const std::string& families, ServingPlan& plan) {
  std::string refusal;
  const std::optional<AxisForceRatio> held = findHeldForce(families, wanted, refusal);
  std::ostringstream note;
  note << "; suction holds the cell, which is served as glued to a ring of "
       << 1e6 * plan.scene->holding_pipette.contact_radius << " um: ";
  note.precision(2);
  if (held && plan.source.data && plan.served == Served::kSurrogate && wanted.needle.offset.isZero(0)) {
    auto corrected = std::make_shared<SurrogateData>(*plan.source.data);
    held->applyTo(*corrected, wanted.radius());
    plan.source.data = std::move(corrected);
    plan.held_family = families;
    plan.glued_error = held->error();
    note << "on the axis its force is corrected by up to " << 100 * held->largestChange()
         << " % to that of the held cell, with an error of " << 100 * held->error() << " %";
  } else {
    plan.glued_error = held ? held->largestChange() : Scene::kGluedError;
    note << "its force is up to " << 100 * plan.glued_error << " % from that of the held cell";
    if (!refusal.empty()) note << " (" << refusal << ')';
  }
  plan.as_required = plan.as_required && plan.glued_error <= wanted.requirements.force_error;
  plan.reason += note.str();
}

/// As planBetween(), for a needle that may rub or adhere: its data have the way in.
ServingPlan planWaysInAndOut(const Scene& scene, const std::string& model, const std::string& families,
                             const std::string& call) {
  const Scene::Contact& contact = scene.needle.contact;
  const bool adheres = contact.adhesion_energy > 0;
  if (!adheres && !(contact.friction > 0)) return planBetween(scene, model, families, call);
  std::string refusal;
  std::optional<WithdrawalLoss> loss = findWithdrawal(families, scene, refusal);
  if (adheres && !loss)
    throw ConfigError("needle/contact/adhesion: must be left out, or be of a cell that a family has: " +
                      (refusal.empty() ? "there are no families" : refusal));
  ServingPlan plan;
  try {
    plan = planBetween(withoutAdhesion(scene), adheres ? "surrogate" : model, families, call);  // live has no adhesion
  } catch (const ConfigError& error) {
    if (!adheres) throw;
    throw ConfigError(std::string("needle/contact/adhesion: ") + error.what() +
                      "; prepare the same scene without adhesion: the way in does not feel it");
  }
  if (plan.served != Served::kSurrogate) return plan;
  std::ostringstream note;
  note.precision(2);
  if (loss) {
    note << "; on the way out it has less, with an error of " << 100 * loss->error() << " % of the force at the turn";
    plan.as_required = plan.as_required && loss->error() <= scene.requirements.force_error;
  } else {
    note << "; on the way out a real one has up to " << 100 * kLostAtMost << " % less";
    if (!refusal.empty()) note << " (" << refusal << ')';
    plan.as_required = plan.as_required && kLostAtMost <= scene.requirements.force_error;
  }
  plan.loss = std::move(loss);
  plan.reason += note.str();
  return plan;
}

/// What the scene's needle does to its outermost layer, by the family that has it; else it is solved. `pierced_error`:
/// as PuncturableCell has it.
PiercedBranch branchFor(const Scene& scene, const CellModelConfig& config, std::string& description,
                        std::optional<double>& pierced_error) {
  std::string refusal;
  if (std::optional<FamilyBranch> found = findFamilyBranch(config.families, scene, refusal)) {
    std::ostringstream text;
    text.precision(2);
    text << "; its branches are those of a family, with errors below " << 100 * found->whole_error << " % before and "
         << 100 * found->pierced_error << " % to 4 tip radii behind the onset in nine of ten; ";
    description += text.str() + describePuncture(found->branch, scene);
    pierced_error = found->pierced_error;
    return std::move(found->branch);
  }
  PiercedBranch solved = storedPiercedBranch(scene, [&](int path, int count) {
    if (config.tell)
      config.tell("solves the cell with holes under the needle, once for this cell and tip: path " +
                  std::to_string(path + 1) + " of " + std::to_string(count));
  });
  description += "; " + describePuncture(solved, scene);
  return solved;
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
    plan = planWaysInAndOut(scene, model, families, call);
  }
  plan.scene = std::make_shared<const Scene>(plan.loss ? withoutAdhesion(scene) : scene);
  if (wanted.holding_pipette.mouth) tellOfSuction(wanted, families, plan);
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
    const bool on_axis_only = plan.source.on_axis_only || plan.glued_error > 0;
    auto surrogate = std::make_unique<SurrogateCellModel>(
        scene, plan.source.data, SurrogateCellModel::MoreError{plan.glued_error, on_axis_only});
    if (scene.needle.contact.friction > 0 || plan.loss)
      chosen.unchangeable = "its friction and adhesion are those of this one only";
    else if (plan.source.family)
      chosen.change = std::make_unique<MemberChange>(wanted, plan.source.family, *surrogate, plan.held_family);
    tracker = std::move(surrogate);
    if (plan.loss)
      tracker = std::make_unique<WithdrawnCell>(std::move(tracker), std::move(*plan.loss), scene.needle.tip.radius);
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
  std::optional<PiercedBranch> branch;
  std::optional<double> pierced_error;
  if (piercedByMechanics(scene)) {
    branch = branchFor(scene, config, chosen.description, pierced_error);
    chosen.change.reset();
    chosen.unchangeable = "its hole under the needle is that of this one only";
  }
  chosen.cell = std::make_unique<PuncturableCell>(scene, std::move(tracker), tongueOf(scene, config.families),
                                                  std::move(branch), pierced_error);
  return chosen;
}

}  // namespace microinjection
