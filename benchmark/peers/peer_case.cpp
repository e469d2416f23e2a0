#include "benchmark/peers/peer_case.h"

#include <cmath>
#include <fstream>
#include <istream>
#include <sstream>
#include <stdexcept>

namespace microinjection {
namespace {

constexpr int kVersion = 1;
constexpr long kLargestCount = 10'000'000;  ///< of the lines of a section: a larger one is a mistake

/// Lines without comments and empty ones, with their numbers for messages.
class Lines {
 public:
  explicit Lines(std::istream& text) : text_(text) {}

  std::istringstream next() {
    for (std::string line; std::getline(text_, line);) {
      ++number_;
      line = line.substr(0, line.find('#'));
      if (line.find_first_not_of(" \t\r") != std::string::npos) return std::istringstream(line);
    }
    fail("the text ends early");
  }

  /// The values behind a keyword.
  std::istringstream expect(const std::string& keyword) {
    std::istringstream line = next();
    std::string found;
    line >> found;
    if (found != keyword) fail("'" + found + "' instead of '" + keyword + "'");
    return line;
  }

  template <typename Value>
  Value value(std::istringstream& line) {
    Value result{};
    if (!(line >> result)) fail("a value is missing or wrong");
    if constexpr (std::is_floating_point_v<Value>) {
      if (!std::isfinite(result)) fail("a number is not finite");
    }
    return result;
  }

  int index(std::istringstream& line, std::size_t count) {
    const long result = value<long>(line);
    if (result < 0 || result >= static_cast<long>(count)) fail("no number " + std::to_string(result));
    return static_cast<int>(result);
  }

  std::size_t count(std::istringstream& line) {
    const long result = value<long>(line);
    if (result < 0 || result > kLargestCount) fail("count out of range");
    return static_cast<std::size_t>(result);
  }

  void end(std::istringstream& line) {
    std::string rest;
    if (line >> rest) fail("'" + rest + "' is left over");
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw std::runtime_error("peer case, line " + std::to_string(number_) + ": " + reason);
  }

 private:
  std::istream& text_;
  int number_ = 0;
};

template <typename Value>
Value single(Lines& lines, const std::string& keyword) {
  std::istringstream line = lines.expect(keyword);
  const Value result = lines.value<Value>(line);
  lines.end(line);
  return result;
}

std::size_t beginList(Lines& lines, const std::string& keyword) {
  std::istringstream line = lines.expect(keyword);
  const std::size_t count = lines.count(line);
  lines.end(line);
  return count;
}

Eigen::Vector3d point(Lines& lines, int dimension) {
  std::istringstream line = lines.next();
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int k = 0; k < dimension; ++k) result[k] = lines.value<double>(line);
  lines.end(line);
  return result;
}

std::vector<int> indices(Lines& lines, std::istringstream& line, int count, std::size_t below) {
  std::vector<int> result;
  for (int k = 0; k < count; ++k) result.push_back(lines.index(line, below));
  lines.end(line);
  return result;
}

std::vector<int> nodeList(Lines& lines, const std::string& keyword, std::size_t below) {
  std::vector<int> result(beginList(lines, keyword));
  for (int& node : result) {
    std::istringstream line = lines.next();
    node = indices(lines, line, 1, below).front();
  }
  return result;
}

void readMesh(Lines& lines, PeerCase& result) {
  std::istringstream head = lines.expect("nodes");
  result.nodes.resize(lines.count(head));
  result.vertices = static_cast<int>(lines.count(head));
  lines.end(head);
  for (Eigen::Vector3d& node : result.nodes) node = point(lines, result.dimension);
  result.elements.resize(beginList(lines, "elements"));
  for (PeerCase::Element& element : result.elements) {
    std::istringstream line = lines.next();
    element.layer = lines.index(line, result.layers.size());
    element.nodes = indices(lines, line, result.elementNodes(), result.nodes.size());
  }
  result.surface.resize(beginList(lines, "surface"));
  for (std::vector<int>& facet : result.surface) {
    std::istringstream line = lines.next();
    facet = indices(lines, line, result.facetNodes(), result.nodes.size());
  }
}

template <typename Values>
void writeValues(std::ostream& text, const Values& values, int count) {
  for (int k = 0; k < count; ++k) text << (k == 0 ? "" : " ") << values[k];
  text << '\n';
}

void writeNodeList(std::ostream& text, const std::string& keyword, const std::vector<int>& nodes) {
  text << keyword << ' ' << nodes.size() << '\n';
  for (const int node : nodes) text << node << '\n';
}

}  // namespace

PeerCase readPeerCase(std::istream& text) {
  Lines lines(text);
  PeerCase result;
  if (single<int>(lines, "peer_case") != kVersion) lines.fail("another version of the format");
  result.scene = single<std::string>(lines, "scene");
  result.dimension = single<int>(lines, "dimension");
  if (result.dimension != 2 && result.dimension != 3) lines.fail("the dimension must be 2 or 3");
  result.order = single<int>(lines, "order");
  if (result.order != 1 && result.order != 2) lines.fail("the order must be 1 or 2");
  result.layers.resize(beginList(lines, "layers"));
  for (PeerCase::Layer& layer : result.layers) {
    std::istringstream line = lines.next();
    layer.law = lines.value<std::string>(line);
    layer.young_modulus = lines.value<double>(line);
    layer.poisson_ratio = lines.value<double>(line);
    lines.end(line);
  }
  readMesh(lines, result);
  result.held = nodeList(lines, "held", result.nodes.size());
  result.glued = nodeList(lines, "glued", result.nodes.size());
  std::istringstream tip = lines.expect("tip");
  result.tip.shape = lines.value<std::string>(tip);
  result.tip.mode = lines.value<std::string>(tip);
  result.tip.radius = lines.value<double>(tip);
  result.tip.height = lines.value<double>(tip);
  lines.end(tip);
  result.motion.resize(beginList(lines, "motion"));
  for (Eigen::Vector3d& step : result.motion) step = point(lines, 3);
  std::istringstream last = lines.expect("end");
  lines.end(last);
  return result;
}

PeerCase readPeerCase(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return readPeerCase(file);
}

std::string peerCaseText(const PeerCase& peer_case) {
  std::ostringstream text;
  text.precision(17);
  text << "peer_case " << kVersion << "\nscene " << peer_case.scene << "\ndimension " << peer_case.dimension
       << "\norder " << peer_case.order << "\nlayers " << peer_case.layers.size() << '\n';
  for (const PeerCase::Layer& layer : peer_case.layers) {
    text << layer.law << ' ' << layer.young_modulus << ' ' << layer.poisson_ratio << '\n';
  }
  text << "nodes " << peer_case.nodes.size() << ' ' << peer_case.vertices << '\n';
  for (const Eigen::Vector3d& node : peer_case.nodes) writeValues(text, node, peer_case.dimension);
  text << "elements " << peer_case.elements.size() << '\n';
  for (const PeerCase::Element& element : peer_case.elements) {
    text << element.layer << ' ';
    writeValues(text, element.nodes, peer_case.elementNodes());
  }
  text << "surface " << peer_case.surface.size() << '\n';
  for (const std::vector<int>& facet : peer_case.surface) writeValues(text, facet, peer_case.facetNodes());
  writeNodeList(text, "held", peer_case.held);
  writeNodeList(text, "glued", peer_case.glued);
  text << "tip " << peer_case.tip.shape << ' ' << peer_case.tip.mode << ' ' << peer_case.tip.radius << ' '
       << peer_case.tip.height << "\nmotion " << peer_case.motion.size() << '\n';
  for (const Eigen::Vector3d& step : peer_case.motion) writeValues(text, step, 3);
  text << "end\n";
  return text.str();
}

}  // namespace microinjection
