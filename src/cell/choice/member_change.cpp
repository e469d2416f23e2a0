#include "cell/choice/member_change.h"

#include "base/errors.h"

namespace microinjection {

std::string MemberChange::change(const std::vector<CellParameter>& parameters) {
  const Scene next = withParameters(scene_, parameters);
  std::string reason;
  const auto member = makeFamilyCell(family_, next, reason);
  if (!member) throw ConfigError(reason.empty() ? "the cell is of another form than its family" : reason);
  cell_.change(next, member->data);
  scene_ = next;
  return member->description;
}

}  // namespace microinjection
