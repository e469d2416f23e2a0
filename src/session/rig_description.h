#pragma once

#include <yaml-cpp/yaml.h>

#include <memory>
#include <string>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace microinjection {

/// The URDF of a rig for a cell of another size: holding pipette, dish, objective and the start of the needle follow
/// the cell.
class RigDescription {
 public:
  /// Heights and sizes, m; heights in world.
  struct Sizes {
    double start_height = 0;                        ///< of the tip, with all joints at 0
    double mouth_height = 0;                        ///< of the holding pipette's mouth
    double floor_height = 0;                        ///< of the dish
    double travel = 0;                              ///< of the tip, down from the start
    double pipette_radius = 0, pipette_length = 0;  ///< of the holding pipette

    bool operator==(const Sizes& other) const;
  };

  /// Throws ConfigError when the file is no URDF with the joints and links that follow the cell.
  explicit RigDescription(const std::string& path);
  ~RigDescription();

  const Sizes& sizes() const { return sizes_; }
  double axisSpeed() const { return axis_speed_; }  ///< m/s, of the slowest axis

  /// Fits the sizes to a cell of `factor` times the size, whose holder has `mouth_radius` (m; 0: unknown).
  void scale(double factor, double mouth_radius);
  /// Puts axes under the holding pipette, whose joint was fixed: those of a file like urdf/holding_axes.urdf, which has
  /// a link holding_base and, behind three axes, a link holding_stage_z.
  void carryHolder(const std::string& axes);
  /// Sets sizes by their names. Errors, a line each, name the key after rig/.
  void override(const YAML::Node& values, std::vector<std::string>& errors);
  /// A line for everything that does not go together with a cell of `radius` (m), into which the needle may go by
  /// `depth` (m). Each begins with the key.
  std::vector<std::string> misfits(double radius, double depth) const;

  bool changed() const;
  /// The URDF with these sizes; the text of the file when nothing has changed.
  std::string text() const;

 private:
  tinyxml2::XMLElement* joint(const std::string& name) const;
  std::string fittedText() const;
  void insertAxes(tinyxml2::XMLDocument& fitted) const;

  std::string path_, file_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
  std::unique_ptr<tinyxml2::XMLDocument> axes_;  ///< of the holding pipette; null: it is fixed
  Sizes sizes_, of_file_;
  double axis_speed_ = 0, cell_factor_ = 1;
};

}  // namespace microinjection
