#include "session/rig_description.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "session/parameter_tree.h"

namespace microinjection {
namespace {

using tinyxml2::XMLElement;

constexpr char kStart[] = "world_to_manipulator_base", kMouth[] = "world_to_holding_pipette", kDown[] = "manipulator_z";
constexpr char kHoldingBase[] = "holding_base", kHoldingStage[] = "holding_stage_z";
constexpr double kFloor = -60e-6;   // m, of the dish in the file
constexpr double kMouthFactor = 3;  // outer radius of a holding pipette over that of its mouth
const char* const kBelow[] = {"world_to_dish", "world_to_objective"};  // joints that sink with the floor

using Member = double RigDescription::Sizes::*;
const std::pair<const char*, Member> kSizes[] = {{"floor_height", &RigDescription::Sizes::floor_height},
                                                 {"mouth_height", &RigDescription::Sizes::mouth_height},
                                                 {"pipette_length", &RigDescription::Sizes::pipette_length},
                                                 {"pipette_radius", &RigDescription::Sizes::pipette_radius},
                                                 {"start_height", &RigDescription::Sizes::start_height},
                                                 {"travel", &RigDescription::Sizes::travel}};

XMLElement* named(const tinyxml2::XMLDocument& document, const char* kind, const std::string& name) {
  const XMLElement* robot = document.RootElement();
  const XMLElement* element = robot ? robot->FirstChildElement(kind) : nullptr;
  while (element && !element->Attribute("name", name.c_str())) element = element->NextSiblingElement(kind);
  return const_cast<XMLElement*>(element);
}

XMLElement* child(XMLElement* element, std::initializer_list<const char*> names) {
  for (const char* name : names) element = element ? element->FirstChildElement(name) : nullptr;
  return element;
}

/// x, y and z of an origin.
std::array<std::string, 3> placeOf(XMLElement* joint) {
  std::array<std::string, 3> place = {"0", "0", "0"};
  const XMLElement* origin = child(joint, {"origin"});
  const char* text = origin ? origin->Attribute("xyz") : nullptr;
  std::istringstream in(text ? text : "");
  for (std::string& each : place) {
    std::string read;
    if (in >> read) each = read;
  }
  return place;
}

double heightOf(XMLElement* joint) { return std::strtod(placeOf(joint)[2].c_str(), nullptr); }

void setHeight(XMLElement* joint, double height) {
  XMLElement* origin = child(joint, {"origin"});
  if (!origin) origin = joint->InsertNewChildElement("origin");
  const std::array<std::string, 3> place = placeOf(joint);
  origin->SetAttribute("xyz", (place[0] + " " + place[1] + " " + numberText(height)).c_str());
}

/// Returns the text of the file.
std::string parseInto(tinyxml2::XMLDocument& document, const std::string& path) {
  std::ifstream in(path);
  if (!in) throw ConfigError(path + ": cannot be read");
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (document.Parse(text.c_str()) != tinyxml2::XML_SUCCESS || !document.RootElement())
    throw ConfigError(path + ": is no URDF: " + document.ErrorStr());
  return text;
}

}  // namespace

bool RigDescription::Sizes::operator==(const Sizes& other) const {
  return std::all_of(std::begin(kSizes), std::end(kSizes),
                     [&](const auto& size) { return this->*size.second == other.*size.second; });
}

RigDescription::RigDescription(const std::string& path)
    : path_(path), document_(std::make_unique<tinyxml2::XMLDocument>()) {
  file_ = parseInto(*document_, path);
  sizes_.start_height = heightOf(joint(kStart));
  sizes_.mouth_height = heightOf(joint(kMouth));
  sizes_.floor_height = kFloor;
  axis_speed_ = std::numeric_limits<double>::infinity();
  for (const char* name : {"manipulator_x", "manipulator_y", kDown}) {
    const XMLElement* limit = child(joint(name), {"limit"});
    if (!limit || !limit->Attribute("velocity"))
      throw ConfigError(path + ": joint " + name + " has no <limit> with a velocity; must have one, in m/s");
    axis_speed_ = std::min(axis_speed_, limit->DoubleAttribute("velocity"));
  }
  sizes_.travel = -child(joint(kDown), {"limit"})->DoubleAttribute("lower");
  const XMLElement* cylinder =
      child(named(*document_, "link", "holding_pipette"), {"collision", "geometry", "cylinder"});
  if (!cylinder) throw ConfigError(path + ": has no link holding_pipette whose <collision> is a cylinder");
  sizes_.pipette_radius = cylinder->DoubleAttribute("radius");
  sizes_.pipette_length = cylinder->DoubleAttribute("length");
  of_file_ = sizes_;
}

RigDescription::~RigDescription() = default;

XMLElement* RigDescription::joint(const std::string& name) const {
  XMLElement* found = named(*document_, "joint", name);
  if (!found) throw ConfigError(path_ + ": has no joint " + name);
  return found;
}

void RigDescription::carryHolder(const std::string& path) {
  axes_ = std::make_unique<tinyxml2::XMLDocument>();
  parseInto(*axes_, path);
  for (const char* link : {kHoldingBase, kHoldingStage})
    if (!named(*axes_, "link", link)) throw ConfigError(path + ": has no link " + link);
}

/// The fixed joint of the holding pipette now has the axes behind it, and its turn is at their end.
void RigDescription::insertAxes(tinyxml2::XMLDocument& fitted) const {
  for (const XMLElement* part = axes_->RootElement()->FirstChildElement(); part; part = part->NextSiblingElement())
    fitted.RootElement()->InsertEndChild(part->DeepClone(&fitted));
  XMLElement* mouth = named(fitted, "joint", kMouth);
  XMLElement* origin = child(mouth, {"origin"});
  const char* turn = origin->Attribute("rpy");
  const std::string rpy = turn ? turn : "0 0 0";
  mouth->SetAttribute("name", "world_to_holding_base");
  child(mouth, {"child"})->SetAttribute("link", kHoldingBase);
  origin->DeleteAttribute("rpy");
  XMLElement* last = fitted.RootElement()->InsertNewChildElement("joint");
  last->SetAttribute("name", "holding_stage_z_to_holding_pipette");
  last->SetAttribute("type", "fixed");
  last->InsertNewChildElement("parent")->SetAttribute("link", kHoldingStage);
  last->InsertNewChildElement("child")->SetAttribute("link", "holding_pipette");
  last->InsertNewChildElement("origin")->SetAttribute("rpy", rpy.c_str());
}

void RigDescription::scale(double factor, double mouth_radius) {
  using S = Sizes;
  cell_factor_ = factor;
  if (factor != 1) {
    for (const Member size : {&S::start_height, &S::mouth_height, &S::floor_height, &S::travel, &S::pipette_length})
      sizes_.*size = roundedParameter(factor * sizes_.*size);
  }
  if (mouth_radius > 0) sizes_.pipette_radius = roundedParameter(kMouthFactor * mouth_radius);
}

void RigDescription::override(const YAML::Node& values, std::vector<std::string>& errors) {
  std::vector<std::string> allowed;
  for (const auto& size : kSizes) allowed.emplace_back(size.first);
  for (const auto& item : values) {
    const std::string name = item.first.Scalar();
    const auto size =
        std::find_if(std::begin(kSizes), std::end(kSizes), [&](const auto& each) { return each.first == name; });
    double value = 0;
    if (size == std::end(kSizes)) {
      errors.push_back("rig/" + name + ": unknown key; known here: " + join(allowed, ", "));
    } else if (!item.second.IsScalar() || !YAML::convert<double>::decode(item.second, value) || !std::isfinite(value)) {
      errors.push_back("rig/" + name + " = " + YAML::Dump(item.second) + ": must be a number, in m");
    } else {
      sizes_.*size->second = value;
    }
  }
}

std::vector<std::string> RigDescription::misfits(double radius, double depth) const {
  std::vector<std::string> found;
  const auto add = [&](const char* name, double value, const std::string& reason) {
    found.push_back("rig/" + std::string(name) + " = " + shortNumber(value) + " m: " + reason);
  };
  const Sizes& s = sizes_;
  if (s.start_height <= radius)
    add("start_height", s.start_height,
        "the needle starts in the cell; must be above its radius, " + shortNumber(radius) + " m");
  if (s.start_height - s.travel > radius - depth)
    add("travel", s.travel,
        "the needle does not reach injection_controller/depth_limit; must be at least " +
            shortNumber(s.start_height - radius + depth) + " m");
  if (s.mouth_height > -0.8 * radius || s.mouth_height < -1.2 * radius)
    add("mouth_height", s.mouth_height,
        "the holding pipette does not hold the cell; must be about " + shortNumber(-radius) + " m");
  if (s.floor_height >= s.mouth_height)
    add("floor_height", s.floor_height,
        "the cell lies in the dish's floor; must be below rig/mouth_height = " + shortNumber(s.mouth_height) + " m");
  return found;
}

bool RigDescription::changed() const { return !(sizes_ == of_file_) || cell_factor_ != 1 || axes_; }

std::string RigDescription::text() const { return changed() ? fittedText() : file_; }

std::string RigDescription::fittedText() const {
  tinyxml2::XMLDocument fitted;
  document_->DeepCopy(&fitted);
  const auto joint_of = [&](const char* name) { return named(fitted, "joint", name); };
  setHeight(joint_of(kStart), sizes_.start_height);
  setHeight(joint_of(kMouth), sizes_.mouth_height);
  for (const char* name : kBelow) {
    XMLElement* below = joint_of(name);
    if (below) setHeight(below, heightOf(below) + sizes_.floor_height - kFloor);
  }
  child(joint_of(kDown), {"limit"})->SetAttribute("lower", numberText(-sizes_.travel).c_str());
  XMLElement* visual = child(named(fitted, "link", "cell"), {"visual"});
  for (; visual; visual = visual->NextSiblingElement("visual")) {
    XMLElement* sphere = child(visual, {"geometry", "sphere"});
    if (sphere)
      sphere->SetAttribute("radius",
                           numberText(roundedParameter(cell_factor_ * sphere->DoubleAttribute("radius"))).c_str());
  }
  for (const char* part : {"visual", "collision"}) {
    XMLElement* body = child(named(fitted, "link", "holding_pipette"), {part});
    for (; body; body = body->NextSiblingElement(part)) {
      XMLElement* cylinder = child(body, {"geometry", "cylinder"});
      if (!cylinder) continue;
      cylinder->SetAttribute("radius", numberText(sizes_.pipette_radius).c_str());
      cylinder->SetAttribute("length", numberText(sizes_.pipette_length).c_str());
      XMLElement* origin = child(body, {"origin"});
      if (!origin) origin = body->InsertNewChildElement("origin");
      origin->SetAttribute("xyz", ("0 0 " + numberText(sizes_.pipette_length / 2)).c_str());
    }
  }
  if (axes_) insertAxes(fitted);
  tinyxml2::XMLPrinter printer;
  fitted.Print(&printer);
  return printer.CStr();
}

}  // namespace microinjection
