#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cell/model/disc_contact_cell.h"
#include "cell/model/tensegrity_indentation.h"
#include "cell/tensegrity/tensegrity_structure.h"

namespace microinjection {

/// The cell of a tensegrity scene. The needle touches its membrane at any point; strut ends are
/// vertices of it. The needle does not touch struts or cables inside.
class TensegrityCell : public DiscContactCell {
 public:
  /// Throws ConfigError when the scene is not valid or of another model, std::runtime_error as
  /// TensegrityStructure.
  explicit TensegrityCell(const Scene& scene);

  const TensegrityStructure& structure() const { return *structure_; }
  /// Throws std::invalid_argument when the patch and the held strut ends overlap.
  std::unique_ptr<TensegrityIndentation> indentation(const TipPatch& patch) const;
  std::string description() const override;
  std::unique_ptr<TipPath> path(const ContactPoint& contact_point) const override;
  std::vector<CellModel::Member> undeformedMembers() const override;

 private:
  std::shared_ptr<const TensegrityStructure> structure_;
};

}  // namespace microinjection
