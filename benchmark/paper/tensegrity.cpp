// The tensegrity cell of the paper (section III.A): Table II, Figures 2, 3, 11, 12 and 13 as
// tables; see --help.

#include <boost/program_options.hpp>
#include <iostream>
#include <string>

#include "base/errors.h"
#include "benchmark/paper/tensegrity_common.h"
#include "benchmark/paper/tensegrity_curves.h"
#include "benchmark/paper/tensegrity_members.h"
#include "benchmark/paper/tensegrity_numbers.h"
#include "benchmark/paper/tensegrity_shapes.h"

namespace microinjection {
namespace {

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tensegrity.yaml";

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string folder, scene;
  po::options_description options(
      "tensegrity: the paper's tensegrity cell, Table II and Figures 2, 3 and 11 to 13 as CSV tables. Options");
  options.add_options()("help", "this text")("out", po::value(&folder),
                                             "folder to write tensegrity_*.csv to; required")(
      "scene", po::value(&scene)->default_value(kScene), "scene file of model tensegrity");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, options), values);
  po::notify(values);
  if (values.count("help") != 0 || folder.empty()) {
    std::cout << options;
    return folder.empty() && values.count("help") == 0 ? 2 : 0;
  }
  const TensegrityStudy study{loadScene(scene), folder};
  if (!study.scene.cell.tensegrity) throw ConfigError(scene + ": cell/model: must be tensegrity");
  writeMembers(study);
  writeNumbers(study);
  writeBending(study);
  writeShapes(study);
  writeCurves(study);
  return 0;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  try {
    return microinjection::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "tensegrity: " << error.what() << '\n';
    return 2;
  }
}
