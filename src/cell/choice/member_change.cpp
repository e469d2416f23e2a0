#include "cell/choice/member_change.h"

#include "base/errors.h"
#include "cell/family/axis_force_ratio.h"

namespace microinjection {

std::string MemberChange::change(const std::vector<CellParameter>& parameters) {
  const Scene next = withParameters(scene_, parameters);
  const Scene glued = next.glued();
  std::string reason;
  const auto member = makeFamilyCell(family_, glued, reason);
  if (!member) throw ConfigError(reason.empty() ? "the cell is of another form than its family" : reason);
  std::shared_ptr<const SurrogateData> data = member->data;
  if (!held_family_.empty()) {
    const std::optional<AxisForceRatio> held = findHeldForce(held_family_, next, reason);
    if (!held) throw ConfigError("suction holds the cell: " + reason);
    auto corrected = std::make_shared<SurrogateData>(*data);
    held->applyTo(*corrected, next.radius());
    data = std::move(corrected);
  }
  cell_.change(glued, data);
  scene_ = next;
  return member->description;
}

}  // namespace microinjection
