#pragma once

#include <memory>
#include <vector>

#include "cell/live_cell.h"
#include "tensegrity/tensegrity_structure.h"

namespace microinjection {

/// The cell of a scene of model tensegrity: the needle meets its membrane anywhere, strut ends being vertices of it.
/// A strut or cable inside is not met by the needle.
class TensegrityCell : public LiveCell {
 public:
  /// Throws ConfigError when the scene is not valid or of another model, std::runtime_error as TensegrityStructure.
  explicit TensegrityCell(const Scene& scene);

  const TensegrityStructure& structure() const { return *structure_; }
  std::unique_ptr<LiveIndentation> indentation(const TipPatch& patch) const override;
  std::vector<CellUnderNeedle::Member> membersAtRest() const override;

 private:
  std::shared_ptr<const TensegrityStructure> structure_;
};

}  // namespace microinjection
