#include "hardware/manipulator/rig_model.h"

#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include "base/errors.h"

namespace microinjection {

urdf::ModelInterfaceSharedPtr parseRig(const std::string& xml) {
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(xml);
  if (!model) throw ConfigError("robot_description: is not a URDF");
  return model;
}

Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const urdf::Rotation& r = pose.rotation;
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  result.translation() << pose.position.x, pose.position.y, pose.position.z;
  return result;
}

std::vector<urdf::JointConstSharedPtr> chainTo(const urdf::ModelInterface& model, const std::string& name) {
  std::vector<urdf::JointConstSharedPtr> chain;
  urdf::LinkConstSharedPtr link = model.getLink(name);
  if (!link) throw ConfigError("URDF: link " + name + " is missing");
  while (link->parent_joint) {
    chain.push_back(link->parent_joint);
    link = link->getParent();
  }
  if (link->name != "world")
    throw ConfigError("URDF: " + name + " is connected to " + link->name + ", must be connected to world");
  std::reverse(chain.begin(), chain.end());
  return chain;
}

Eigen::Vector3d unitAxis(const urdf::Joint& joint) {
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.norm() > 1e-6)) throw ConfigError("URDF: joint " + joint.name + ": axis must not be zero");
  return axis.normalized();
}

double accelerationLimit(const std::string& xml, const std::string& name) {
  tinyxml2::XMLDocument document;
  document.Parse(xml.c_str());
  const tinyxml2::XMLElement* robot = document.FirstChildElement("robot");
  const tinyxml2::XMLElement* joint = robot ? robot->FirstChildElement("joint") : nullptr;
  while (joint && !joint->Attribute("name", name.c_str())) joint = joint->NextSiblingElement("joint");
  const tinyxml2::XMLElement* limit = joint ? joint->FirstChildElement("limit") : nullptr;
  const char* attribute = limit ? limit->Attribute("acceleration") : nullptr;
  const std::string where = "URDF: joint " + name + ": attribute acceleration of <limit> ";
  if (!attribute) throw ConfigError(where + "is missing, must be a number above 0 (m/s^2)");
  std::istringstream text(attribute);
  text.imbue(std::locale::classic());
  double value = 0;
  text >> value;
  const bool is_number = !text.fail() && (text >> std::ws).eof();
  if (!is_number || !std::isfinite(value) || !(value > 0)) {
    throw ConfigError(where + "= " + attribute + ", must be a number above 0 (m/s^2)");
  }
  return value;
}

}  // namespace microinjection
