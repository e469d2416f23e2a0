#include "cell/family/tongue_family.h"

#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "cell/family/family_file.h"
#include "cell/family/tongue_member.h"

namespace microinjection {

TongueFamily::TongueFamily(SectionFamilyData data) : data_(std::move(data)) {
  if (data_.family().kind() != SectionFamily::Kind::kTongue)
    throw std::invalid_argument("family " + data_.family().name() + " has no tongues");
  for (const SectionMember& member : data_.members()) {
    if (member.curves.rows() != TongueCurves::kNodes || member.curves.cols() != TongueCurves::kColumns)
      throw ConfigError("family " + data_.family().name() + ": its data have other curves than tongues");
  }
}

TongueFamily TongueFamily::load(const std::string& family_file) {
  if (SectionFamily::kindOf(family_file) != SectionFamily::Kind::kTongue)
    throw ConfigError(family_file + ": is no family of tongues: its key `tongue` is missing");
  return TongueFamily(SectionFamilyData::loadBoth(family_file));
}

FamilyTongue TongueFamily::tongue(const Eigen::VectorXd& coordinates) const {
  const SectionFamilyData::Prediction found = data_.predict(coordinates);
  const Scene member = data_.family().member(coordinates);
  return {touchOf(member), tongueGrowth(member), found.curves, found.error[0], found.error[1]};
}

FamilyTongue TongueFamily::tongue(const Scene& scene) const { return tongue(data_.coordinatesOf(scene)); }

std::optional<FamilyTongue> findFamilyTongue(const std::string& families, const Scene& scene, std::string& reason) {
  return firstFamilyWith(families, "tongues", reason,
                         [&](const std::string& file) { return TongueFamily::load(file).tongue(scene); });
}

}  // namespace microinjection
