#pragma once

#include <string>
#include <vector>

#include "cell/model/scene.h"
#include "cell/tensegrity/tensegrity_structure.h"

namespace microinjection {

/// What the tables of the tensegrity cell are made of, and where they go.
struct TensegrityStudy {
  Scene scene;  ///< of model tensegrity
  std::string folder;

  const TensegrityConfig& config() const { return *scene.cell.tensegrity; }
  /// Writes FOLDER/tensegrity_TABLE.csv.
  void write(const std::string& table, const std::string& text) const;
};

/// printf into a string.
std::string line(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// What the needle meets.
enum class Where { kEnd, kMiddle, kEndOfIt, kBetween };  ///< kEndOfIt: of the strut of kMiddle
const char* name(Where where);

int topEnd(const TensegrityGeometry& geometry);  ///< the highest strut end
/// Nodes that move with the needle.
std::vector<int> following(const TensegrityStructure& structure, Where where, double tip_radius);

}  // namespace microinjection
