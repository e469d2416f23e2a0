#include "benchmark/paper/tensegrity_common.h"

#include <cstdarg>
#include <cstdio>

#include "base/atomic_file.h"
#include "cell/contact/tip_patch.h"

namespace microinjection {
namespace {

int topStrut(const TensegrityGeometry& geometry) {
  const auto height = [&](int strut) {
    return (geometry.ends[geometry.struts[strut][0]] + geometry.ends[geometry.struts[strut][1]]).z();
  };
  int top = 0;
  for (int strut = 1; strut < 6; ++strut) {
    if (height(strut) > height(top) + 1e-12) top = strut;
  }
  return top;
}

}  // namespace

void TensegrityStudy::write(const std::string& table, const std::string& text) const {
  writeFileAtomically(folder + "/tensegrity_" + table + ".csv", text);
}

std::string line(const char* format, ...) {
  char text[500];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  return text;
}

const char* name(Where where) {
  constexpr const char* kNames[] = {"end", "middle", "end", "between"};
  return kNames[static_cast<int>(where)];
}

int topEnd(const TensegrityGeometry& geometry) {
  int top = 0;
  for (int end = 1; end < 12; ++end) {
    if (geometry.ends[end].z() > geometry.ends[top].z() + 1e-12) top = end;
  }
  return top;
}

std::vector<int> following(const TensegrityStructure& structure, Where where, double tip_radius) {
  const TensegrityGeometry& geometry = structure.geometry();
  if (where == Where::kEnd) return {structure.endNode(topEnd(geometry))};
  if (where == Where::kMiddle) return structure.middleNodes(topStrut(geometry));
  if (where == Where::kEndOfIt) return {structure.endNode(geometry.struts[topStrut(geometry)][0])};
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  return findTipPatch(structure.surface(), structure.config().radius * up, up, tip_radius).vertices;
}

}  // namespace microinjection
