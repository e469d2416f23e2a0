#include "session/session.h"

#include <regex>

#include "base/config_reader.h"
#include "session/parameter_tree.h"
#include "session/session_choices.h"
#include "session/session_plan.h"
#include "session/session_reader.h"
#include "session_folder.h"

namespace microinjection {
namespace {

class SessionTest : public SessionFolder {
 protected:
  std::string refused(const std::vector<std::string>& arguments) {
    return refusalOf([&] { session(arguments); });
  }
  std::string refusedFile(const std::string& text, const std::string& name = "lab.yaml") {
    const std::string path = file(name, text);
    return refusalOf([&] { Session::load(path, {}, kPackage); });
  }
};

void keysOf(const YAML::Node& map, const std::string& path, std::map<std::string, YAML::Node>& keys) {
  for (const auto& item : map) {
    const std::string key = path + item.first.Scalar();
    if (item.second.IsMap() && key != "overrides")
      keysOf(item.second, key + "/", keys);
    else
      keys[key].reset(item.second);
  }
}

TEST_F(SessionTest, DefaultFileHasAllKeysWithTheirDefaults) {
  std::map<std::string, YAML::Node> of_file, of_text;
  keysOf(loadYamlMap(kPackage + "/config/sessions/default.yaml"), "", of_file);
  const std::string empty = file("empty.yaml", "version: 1\n");
  const Session without = Session::load(empty, {}, kPackage), with = session();
  keysOf(YAML::Load(without.text()), "", of_text);
  for (const auto& each : of_text) EXPECT_EQ(of_file.count(each.first), 1u) << each.first;
  EXPECT_EQ(of_file.size(), of_text.size() + 1);  // base
  EXPECT_EQ(without.text(), with.text());
  // A default may be the outcome of `auto`: it is also what is in effect without the key.
  for (const auto& each : of_file) {
    if (each.first == "version" || each.first == "base") continue;
    std::string key = std::regex_replace(each.first, std::regex("/"), ".");
    EXPECT_EQ(session({key + ":=" + YAML::Dump(each.second)}).text(), without.text()) << key;
  }
}

TEST_F(SessionTest, ItsTextIsASessionThatIsTheSame) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {},
           {"hand.device:=dvrk", "hand.topics.namespace:=/MTML", "record.folder:=/tmp/a b", "record.trainee:='12'"},
           {"rig.name:=zaber", "rig.port:=/dev/ttyUSB0", "overrides.injection_controller.force_limit:=20e-6",
            "overrides.haptic_bridge.device_axes:=x y z", "overrides.injector.serial.codes.inject:='012'"},
           {"hand.device:=none", "injection.mode:=semi_automatic", "link.delay:=0.01", "camera.source:=sim"}}) {
    const Session first = session(arguments);
    const Session second = Session::load(file("again.yaml", first.text()), {}, kPackage);
    EXPECT_EQ(second.text(), first.text());
  }
}

TEST_F(SessionTest, AcceptsEachAllowedValue) {
  const SessionChoices choices(kPackage);
  const std::map<std::string, std::vector<std::string>> allowed = {{"model", choices.models},
                                                                   {"rig.name", choices.rigs},
                                                                   {"sensor.source", choices.sensors},
                                                                   {"injector", choices.injectors},
                                                                   {"holder", choices.holders},
                                                                   {"holder_rig.name", choices.holder_rigs},
                                                                   {"hand.device", choices.hands},
                                                                   {"hand.position_type", choices.position_types},
                                                                   {"force.controller", choices.controller_forces},
                                                                   {"force.hand", choices.hand_forces},
                                                                   {"injection.mode", choices.modes},
                                                                   {"link.scheme", choices.schemes},
                                                                   {"camera.source", choices.cameras},
                                                                   {"display.console", choices.consoles},
                                                                   {"estimator", {"true", "false", "True"}},
                                                                   {"display.rviz", {"true", "false"}},
                                                                   {"injection.auto_enable", {"true", "false", "auto"}},
                                                                   {"rig.allow_network", {"true", "false", "auto"}}};
  for (const auto& [key, values] : allowed) {
    EXPECT_GT(values.size(), 1u) << key;
    for (const std::string& value : values) {
      std::vector<std::string> arguments = {key + ":=" + value};
      if (key == "injection.mode") arguments.push_back("hand.device:=none");
      if (value == "folder" || value == "video") arguments.push_back("camera.path:=/nowhere");
      EXPECT_EQ(refused(arguments), "") << key << " " << value;
      EXPECT_NE(planOf(session(arguments), SessionClock::kWall).text, "") << key << " " << value;
    }
    EXPECT_NE(refused({key + ":=wrong"}).find("wrong: must be "), std::string::npos) << refused({key + ":=wrong"});
  }
  EXPECT_EQ(refused({"estimator:=true", "sensor.source:=none", "camera.source:=sim"}), "");
}

TEST_F(SessionTest, NamesKeyValueAndWhatIsAllowed) {
  EXPECT_EQ(refused({"model:=wrong"}), "argument: model = wrong: must be one of: auto, surrogate, live, explicit");
  EXPECT_NE(refused({"rig.name:=lathe"}).find("argument: rig/name = lathe: must be one of: sim, eppendorf, mp285"),
            std::string::npos);
  EXPECT_NE(refused({"estimator:=maybe"}).find("estimator = maybe: must be true or false"), std::string::npos);
}

TEST_F(SessionTest, NamesWhatDoesNotGoTogether) {
  const std::string scene = kPackage + "/config/cells/mouse_oocyte.yaml";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"cell:=/nowhere.yaml"},
       "cell = /nowhere.yaml: no such file: /nowhere.yaml; must be a path, or a name of "
       "config/cells: human_oocyte, human_oocyte_held, mouse"},
      {{"injection.mode:=automatic"},
       "injection/mode = automatic with hand/device = virtual_hand: must be manual, or with hand/device = none"},
      {{"hidden:=/nowhere.yaml"}, "hidden = /nowhere.yaml: no such file"},
      {{"hidden:=" + scene, "rig.name:=zaber"}, " with rig/name = zaber: must be with sim or an emulated rig"},
      {{"estimator:=true", "sensor.source:=none"},
       "estimator = true with sensor/source = none and camera/source = none: must be with"},
      {{"estimator:=true", "rig.name:=zaber"},
       "estimator = true with force/controller = predicted and rig/name = zaber"},
      {{"estimator:=true", "rig.name:=zaber", "sensor.source:=none", "camera.source:=device"},
       "an image does not show the puncture"},
      {{"sensor.source:=none", "force.controller:=measured"}, "force/controller = measured with sensor/source = none"},
      {{"sensor.source:=none", "force.hand:=blend"}, "force/hand = blend with sensor/source = none"},
      {{"record.trainee:=ann"}, "record/trainee = ann with record/folder = \"\": must be with the folder of a record"},
      {{"record.end_when_done:=true"}, "record/end_when_done = true with record/folder = \"\""},
      {{"camera.source:=video"}, "camera/source = video with camera/path = \"\": must be with the path"},
      {{"display.markers:=false", "display.rviz:=true"}, "display/rviz = true with display/markers = false"},
      {{"display.markers:=false", "display.console:=train"}, "display/console = train with display/markers = false"}};
  for (const auto& [arguments, what] : cases) {
    const std::string found = refused(arguments);
    EXPECT_NE(found.find(what), std::string::npos) << found << "\nhas not\n" << what;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
}

TEST_F(SessionTest, RefusesAFileWithLineKeyValueAndWhatIsAllowedAllErrorsAtOnce) {
  const std::string found = refusedFile(
      "version: 1\nrig:\n  name: lathe\n  speed: 3\nestimator: perhaps\nhand: {motion: none.yaml}\nestimator: true\n");
  const std::string lab = path("lab.yaml");
  for (const std::string& part :
       {lab + ", line 3: rig/name = lathe: must be one of: sim, eppendorf",
        lab + ", line 4: rig/speed: unknown key; known here: allow_network, config, name, namespace, port, urdf",
        lab + ", line 5: estimator = perhaps: must be true or false",
        lab + ", line 6: hand/motion = none.yaml: no such file: " + path("none.yaml"),
        lab + ", line 7: estimator: is there twice, first in line 5; must be there once"})
    EXPECT_NE(found.find(part), std::string::npos) << found << "\nhas not\n" << part;
}

TEST_F(SessionTest, NamesTheLinesOfKeysThatDoNotGoTogether) {
  EXPECT_EQ(refusedFile("version: 1\nhand:\n  device: keyboard\ninjection:\n  mode: automatic\n"),
            path("lab.yaml") +
                ", line 5: injection/mode = automatic with hand/device = keyboard: must be manual, or with "
                "hand/device = none");
}

TEST_F(SessionTest, RefusesOtherVersions) {
  const std::string lab = path("lab.yaml");
  EXPECT_EQ(refusedFile("estimator: true\n"), lab + ", line 1: version is missing");
  EXPECT_EQ(refusedFile("version: 2\n"),
            lab + ", line 1: version = 2: must be 1: the file is for a newer version of this program");
  EXPECT_NE(
      refusedFile("version: 0\n").find("version = 0: must be 1, of which config/sessions/default.yaml has all keys"),
      std::string::npos);
  EXPECT_NE(refusedFile("version: new\n").find("version = new: must be an integer"), std::string::npos);
}

TEST_F(SessionTest, NamesSessionsThatAreNotThere) {
  const auto refusal = [](const std::string& name) { return refusalOf([&] { Session::load(name, {}, kPackage); }); };
  EXPECT_NE(refusal("nothing").find("session = nothing: no such file: " + kPackage +
                                    "/config/sessions/nothing.yaml; must be a path, or a name of config/sessions: "),
            std::string::npos)
      << refusal("nothing");
  EXPECT_NE(refusal("nothing").find("default"), std::string::npos);
  EXPECT_NE(refusal("/no/such.yaml").find("no such file: /no/such.yaml"), std::string::npos);
  EXPECT_NE(refusedFile("- 1\n").find("must be a YAML map"), std::string::npos);
  EXPECT_NE(refusedFile("version: 1\n a: [\n").find("lab.yaml: yaml-cpp: error at line"), std::string::npos);
}

TEST_F(SessionTest, ABaseIsOverriddenKeyByKey) {
  file("lab/base.yaml",
       "version: 1\nrig: {name: zaber, port: /dev/ttyUSB0}\nhand: {device: omni}\n"
       "overrides: {display: {rate: 10, marker_rate: 5}, focus: {a: 1}}\n");
  const std::string today = file("today.yaml",
                                 "version: 1\nbase: lab/base.yaml\nrig: {port: /dev/ttyUSB1}\n"
                                 "overrides: {display: {rate: 20}}\n");
  const Session session = Session::load(today, {}, kPackage);
  EXPECT_EQ(session.rig.name, "zaber");
  EXPECT_EQ(session.rig.port, "/dev/ttyUSB1");
  EXPECT_EQ(session.hand.device, "omni");
  EXPECT_FALSE(session.injection.auto_enable);
  EXPECT_EQ(parameterAt(session.overrides, "display/rate").Scalar(), "20");
  EXPECT_EQ(parameterAt(session.overrides, "display/marker_rate").Scalar(), "5");
  EXPECT_EQ(session.places.at("rig/port"), today + ", line 3");
  EXPECT_EQ(session.places.at("rig/name"), path("lab/base.yaml") + ", line 2");
  EXPECT_EQ(session.places.at("estimator"), today);
  EXPECT_EQ(session.places.at("overrides/display/rate"), today + ", line 4");
  // auto takes back what the base says.
  const std::string back = file("back.yaml", "version: 1\nbase: today.yaml\nrig: {name: sim, port: auto}\n");
  EXPECT_EQ(Session::load(back, {}, kPackage).rig.port, "auto");
  EXPECT_TRUE(Session::load(back, {}, kPackage).injection.auto_enable);
  // By name.
  EXPECT_EQ(Session::load(file("named.yaml", "version: 1\nbase: default\nestimator: true\n"), {}, kPackage).estimator,
            true);
}

TEST_F(SessionTest, NamesBasesThatAreWrong) {
  file("a.yaml", "version: 1\nbase: b.yaml\n");
  file("b.yaml", "version: 1\nbase: ./c.yaml\n");
  file("c.yaml", "version: 1\nbase: a.yaml\n");
  EXPECT_EQ(refusalOf([&] { Session::load(path("a.yaml"), {}, kPackage); }),
            path("c.yaml") + ", line 2: base = a.yaml: is its own base: " + path("a.yaml") + " -> " + path("b.yaml") +
                " -> " + path("c.yaml") + " -> " + path("a.yaml"));
  EXPECT_NE(refusedFile("version: 1\nbase: nobody\n").find("lab.yaml, line 2: base = nobody: no such file"),
            std::string::npos);
  file("wrong.yaml", "version: 1\nestimator: 3\n");
  const std::string both = refusedFile("version: 1\nbase: wrong.yaml\nmodel: 4\n");
  EXPECT_NE(both.find("wrong.yaml, line 2: estimator = 3"), std::string::npos) << both;
  EXPECT_NE(both.find("lab.yaml, line 3: model = 4"), std::string::npos) << both;
}

TEST_F(SessionTest, PathsAreRelativeToTheFileThatNamesThem) {
  file("lab/cells/mine.yaml", "a: 1\n");
  file("lab/hand.csv", "\n");
  file("lab/base.yaml", "version: 1\ncell: cells/mine.yaml\nhand: {motion: ./hand.csv}\nrecord: {folder: ../out}\n");
  const std::string today = file("today.yaml", "version: 1\nbase: lab/base.yaml\nnotebook: notes.csv\n");
  const Session session = Session::load(today, {"record.folder:=here"}, kPackage);
  EXPECT_EQ(session.cell, path("lab/cells/mine.yaml"));
  EXPECT_EQ(session.hand.motion, path("lab/hand.csv"));
  EXPECT_EQ(session.notebook, path("notes.csv"));
  EXPECT_EQ(session.record.folder, (std::filesystem::current_path() / "here").string());
  EXPECT_EQ(Session::load(today, {}, kPackage).record.folder, path("out"));
  ::setenv("HOME", "/home/ann", 1);
  EXPECT_EQ(Session::load(today, {"record.folder:=~/records"}, kPackage).record.folder, "/home/ann/records");
  EXPECT_EQ(Session::load(today, {"cell:=zebrafish_embryo"}, kPackage).cell,
            kPackage + "/config/cells/zebrafish_embryo.yaml");
}

TEST_F(SessionTest, DefaultsFollowOtherKeys) {
  const Session real = session({"rig.name:=zaber"}), emulated = session({"rig.name:=emulated_zaber"});
  EXPECT_EQ(real.sensor.source, "serial");
  EXPECT_EQ(real.injector, "serial");
  EXPECT_FALSE(real.rig.allow_network);
  EXPECT_FALSE(real.injection.auto_enable);
  EXPECT_FALSE(real.injection.start_when_enabled);
  EXPECT_EQ(emulated.sensor.source, "simulated");
  EXPECT_TRUE(emulated.rig.allow_network);
  EXPECT_EQ(emulated.rig.config, kPackage + "/config/rigs/zaber.yaml");
  EXPECT_EQ(session({"rig.config:=imperfect"}).rig.config, kPackage + "/config/rigs/imperfect.yaml");
  EXPECT_EQ(session({"hand.device:=none"}).injection.mode, "automatic");
  EXPECT_EQ(session().injection.mode, "manual");
  EXPECT_EQ(session({"force.controller:=measured"}).force.hand, "measured");
  EXPECT_EQ(session({"record.folder:=/a"}).notebook, "/a/notebook.csv");
  EXPECT_EQ(session({"record.folder:=/a", "notebook:=\"\""}).notebook, "");
  EXPECT_EQ(session().notebook, "");
  EXPECT_TRUE(session({"link.loss:=0.1"}).link.emulated);
  EXPECT_FALSE(session().link.emulated);
}

TEST_F(SessionTest, WhatBelongsToADeviceGoesWithIt) {
  const std::string mine = file("mine.yaml", "haptic_device: {kind: omni}\n");
  const std::string lab =
      file("lab.yaml",
           "version: 1\nrig: {name: zaber, port: /dev/ttyUSB0, config: imperfect}\n"
           "hand: {device: dvrk, config: mine.yaml, topics: {namespace: /MTML}, position_type: pose}\n");
  const Session real = Session::load(lab, {}, kPackage);
  EXPECT_EQ(real.rig.port, "/dev/ttyUSB0");
  EXPECT_EQ(real.hand.config, mine);
  const Session emulated = Session::load(lab, {"rig.name:=emulated_zaber"}, kPackage);
  EXPECT_EQ(emulated.rig.config, kPackage + "/config/rigs/imperfect.yaml") << "of the same device";
  const Session other = Session::load(lab, {"rig.name:=sim", "hand.device:=joy"}, kPackage);
  EXPECT_EQ(other.rig.port, "auto");
  const std::string own = file("own.yaml", "version: 1\nrig: {name: external, namespace: /my_rig}\n");
  EXPECT_EQ(Session::load(own, {}, kPackage).rig.name_space, "/my_rig");
  EXPECT_EQ(Session::load(own, {"rig.name:=zaber"}, kPackage).rig.name_space, "auto");
  EXPECT_EQ(other.rig.config, kPackage + "/config/rigs/sim.yaml");
  EXPECT_EQ(other.hand.config, kPackage + "/config/haptic/joy.yaml");
  EXPECT_EQ(other.hand.topics.name_space, "auto");
  EXPECT_EQ(other.hand.position_type, "auto");
  for (const char* hand : {"none", "virtual_hand"})
    EXPECT_EQ(session({std::string("hand.device:=") + hand, "hand.config:=" + mine}).hand.config, "") << hand;
}

TEST_F(SessionTest, ArgumentsAreKeysWithValues) {
  const Session session =
      this->session({"hand.device:=keyboard", "estimator:=", "hand.topics:={namespace: /a, force: /b}",
                     "overrides.injection_controller.motion.stab_speed:=5e-6"});
  EXPECT_EQ(session.hand.device, "keyboard");
  EXPECT_FALSE(session.estimator);
  EXPECT_EQ(session.hand.topics.force, "/b");
  EXPECT_EQ(session.places.at("hand/device"), "argument");
  EXPECT_EQ(parameterAt(session.overrides, "injection_controller/motion/stab_speed").as<double>(), 5e-6);
  EXPECT_NE(refused({"keyboard"}).find("argument keyboard: must be KEY:=VALUE"), std::string::npos);
  EXPECT_EQ(this->session({"hand.device=keyboard"}).hand.device, "keyboard");  // roslaunch takes no := in a value
  EXPECT_EQ(this->session({"record.folder=/a=b", "hand.topics.namespace:=/c:=d"}).record.folder, "/a=b");
  EXPECT_NE(refused({"=a"}).find("must be KEY:=VALUE"), std::string::npos);
  EXPECT_NE(refused({":=a"}).find("must be KEY:=VALUE"), std::string::npos);
  EXPECT_NE(refused({"estimator:=true", "estimator:=false"}).find("argument estimator:=false: is there twice"),
            std::string::npos);
  EXPECT_NE(refused({"rig:=zaber", "rig.port:=/dev/a"}).find("argument rig.port:=/dev/a: is there twice"),
            std::string::npos);
  EXPECT_NE(refused({"rig:=zaber"}).find("argument: rig = zaber: must be a map"), std::string::npos);
  EXPECT_NE(refused({"hand.devise:=omni"}).find("argument: hand/devise: unknown key; known here: config, device"),
            std::string::npos);
  EXPECT_NE(refused({"base:=default"}).find("argument: base: unknown key"), std::string::npos);
  EXPECT_EQ(this->session({"record.folder:=/a: [b"}).record.folder, "/a: [b");  // what is no YAML is a text
}

TEST_F(SessionTest, OverridesMayBeAFile) {
  const std::string mine = file("mine.yaml", "haptic_bridge: {device_axes: -x y z}\nrig: {floor_height: -90.0e-6}\n");
  const Session session = this->session({"overrides:=" + mine});
  EXPECT_EQ(parameterAt(session.overrides, "haptic_bridge/device_axes").Scalar(), "-x y z");
  EXPECT_EQ(session.places.at("overrides/rig/floor_height"), mine + ", line 2");
  const std::string lab = file("lab.yaml", "version: 1\noverrides: mine.yaml\n");
  EXPECT_EQ(Session::load(lab, {}, kPackage).files, (std::vector<std::string>{lab, mine}));
  file("mine.yaml", "controller: {a: 1}\nfocus: 3\nfocus: 4\n");
  const std::string found = refusalOf([&] { Session::load(lab, {}, kPackage); });
  for (const std::string& part :
       {lab + ", line 2: overrides = mine.yaml: " + mine +
            ", line 1: controller: unknown key; known here: calibration, ",
        mine + ", line 2: focus = 3: must be keys with values", mine + ", line 3: focus: is there twice"})
    EXPECT_NE(found.find(part), std::string::npos) << found << "\nhas not\n" << part;
  EXPECT_NE(refused({"overrides:=/nowhere.yaml"}).find("/nowhere.yaml: cannot be read"), std::string::npos);
  EXPECT_EQ(refused({"overrides.display.rate:="}), "");  // not given
  EXPECT_NE(refusedFile("version: 1\noverrides: {display: {rate: }}\n", "null.yaml").find("must have a value"),
            std::string::npos);
  EXPECT_NE(refusedFile("version: 1\noverrides: [1]\n", "list.yaml").find("overrides = [1]: must be a map"),
            std::string::npos);
}

}  // namespace
}  // namespace microinjection
