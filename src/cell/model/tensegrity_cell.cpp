#include "cell/model/tensegrity_cell.h"

#include <sstream>

#include "base/errors.h"

namespace microinjection {
namespace {

const TensegrityConfig& validated(const Scene& scene) {
  scene.validate();
  if (!scene.cell.tensegrity) throw ConfigError("cell/model: must be tensegrity");
  return *scene.cell.tensegrity;
}

}  // namespace

TensegrityCell::TensegrityCell(const Scene& scene)
    : DiscContactCell(scene), structure_(std::make_shared<const TensegrityStructure>(validated(scene))) {
  surface_ = structure_->surface();
  held_vertices_ = structure_->heldNodes();
}

std::unique_ptr<TensegrityIndentation> TensegrityCell::indentation(const TipPatch& patch) const {
  return std::make_unique<TensegrityIndentation>(structure_, patch);
}

std::string TensegrityCell::description() const {
  std::ostringstream text;
  text << "tensegrity of " << structure_->nodePositions().size() << " nodes, " << structure_->struts().elementCount()
       << " tetrahedra; prestress " << structure_->form().prestress << " N, unbalanced " << structure_->form().residual
       << " N";
  return text.str();
}

std::unique_ptr<TipPath> TensegrityCell::path(const ContactPoint& contact_point) const {
  return indentation(contact_point.patch);
}

std::vector<CellModel::Member> TensegrityCell::undeformedMembers() const {
  return tensegrityMembers(*structure_, *structure_->makeParts().cables, structure_->start());
}

}  // namespace microinjection
