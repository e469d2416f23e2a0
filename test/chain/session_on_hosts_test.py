#!/usr/bin/python3
"""session_on_hosts.py: which node it gives to which host, and a session that two hosts start together."""

import os
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "test"), str(ROOT / "test/chain"), str(ROOT / "src/tools")]

import hosts_file  # noqa: E402
import lossy_network  # noqa: E402
import session_on_hosts  # noqa: E402
from in_folder import InFolder  # noqa: E402

TOOL = ROOT / "src/tools/session_on_hosts.py"
PATIENCE = 60  # s of wall time; only what hangs takes that long
ARGUMENTS = ("haptic:=none", "display:=false", "set:=rate=200 injection.start_when_enabled=false")
HOSTS = """master: rig
hosts:
  rig: {address: 10.88.0.1}
  solver: {address: 10.88.0.2, nodes: [cell_simulator], user: lab, env_loader: /opt/env.sh}
"""


class Files(InFolder):
    def setUp(self):
        super().setUp()
        self.file = self.write("hosts.yaml", HOSTS)
        self.hosts = hosts_file.load(self.file)


class AssignTest(Files):
    def config(self):
        from roslaunch.config import ROSLaunchConfig, load_config_default
        text = "".join(f'<node pkg="cell_microinjection" type="{node}" name="{node}"/>'
                       for node in ("cell_simulator", "micromanipulator"))
        config = load_config_default([], None, roslaunch_strs=[f'<launch><param name="a" value="1"/>{text}</launch>'])
        self.assertIsInstance(config, ROSLaunchConfig)
        return config

    def test_by_ssh_each_node_has_its_hosts_machine(self):
        config = self.config()
        session_on_hosts.assign(config, self.hosts)
        machines = {node.name: (node.machine.address, node.machine.user, node.machine.env_loader) for node in config.nodes}
        self.assertEqual(machines["cell_simulator"], ("10.88.0.2", "lab", "env -u ROS_HOSTNAME ROS_IP=10.88.0.2 /opt/env.sh"))
        self.assertEqual(machines["micromanipulator"][0], "localhost")
        self.assertTrue(config.has_remote_nodes())

    def test_a_host_has_its_own_nodes(self):
        for name, nodes in (("rig", ["micromanipulator"]), ("solver", ["cell_simulator"])):
            self.assertEqual(session_on_hosts.nodes_of(self.config(), self.hosts, self.hosts.named(name)), nodes)
        idle = hosts_file.Host("idle", "10.88.0.3", ("nobody",))
        with self.assertRaisesRegex(hosts_file.HostsError, "hosts/idle/nodes: this session has none of them"):
            session_on_hosts.nodes_of(self.config(), self.hosts, idle)

    def test_a_host_starts_only_its_own_nodes_with_their_parameters(self):
        import roslaunch.config

        class Given:
            hosts, arguments = self.file, list(ARGUMENTS)
        files = session_on_hosts.launch_files(Given, ["cell_simulator"])
        config = roslaunch.config.load_config_default(files, None, assign_machines=False)
        self.assertEqual([node.name for node in config.nodes], ["cell_simulator"])
        self.assertIn("/cell_simulator/scene", config.params)
        self.assertFalse([name for name in config.params if name.startswith(("/injector/", "/robot_description"))])

    def test_files_that_the_session_is_made_from_have_to_be_the_same(self):
        scene = self.write("scene.yaml", (ROOT / "test/nodes/scenes/coarse_oocyte.yaml").read_text())

        class Given:
            hosts, arguments = self.file, [f"cell:={scene}"]

        def digest():
            return session_on_hosts.digest(Given, session_on_hosts.load(Given))
        before = digest()
        self.assertEqual(digest(), before)
        self.write("scene.yaml", scene.read_text() + "# another\n")
        self.assertNotEqual(digest(), before)


@unittest.skipUnless(lossy_network.possible(), "no network namespaces: needs root, /dev/net/tun and a system that allows them")
class SessionTest(Files):
    def setUp(self):
        super().setUp()
        self.places = {}
        for name, host in self.hosts.all.items():
            self.places[name] = lossy_network.HostNamespace(host.address)
            self.addCleanup(self.places[name].close)
        switch = lossy_network.LossySwitch(list(self.places.values()), 0.002, 0.0)
        self.addCleanup(switch.close)

    def start(self, name, *arguments):
        log = self.folder / f"{name}.log"
        command = [*self.places[name].enter, sys.executable, "-B", TOOL, "--hosts", self.file, "--host", name, *arguments]
        with open(log, "w", encoding="utf-8") as file:
            process = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                       env={**os.environ, "PYTHONUNBUFFERED": "1", "ROS_LOG_DIR": str(self.folder / name)})
        self.addCleanup(self.end, process)
        return process, log

    @staticmethod
    def end(process):
        if process.poll() is None:
            process.terminate()
            process.wait(PATIENCE)

    def until_said(self, process, log, text):
        end = time.monotonic() + PATIENCE
        while text not in log.read_text(errors="replace"):
            self.assertIsNone(process.poll(), log.read_text(errors="replace"))
            self.assertLess(time.monotonic(), end, log.read_text(errors="replace"))
            time.sleep(0.1)

    def refused(self, name, message, *arguments):
        process, log = self.start(name, *arguments)
        self.assertEqual(process.wait(PATIENCE), 1)
        self.assertIn(message, log.read_text(errors="replace"))

    def test_two_hosts_start_one_session(self):
        self.refused("solver", "solver does not reach 10.88.0.1:11312", *ARGUMENTS)
        self.until_said(*self.start("rig", *ARGUMENTS), "session_on_hosts: rig: started")
        self.refused("solver", "has another hosts file, another session or other arguments", "haptic:=none")
        self.until_said(*self.start("solver", *ARGUMENTS), "session_on_hosts: solver: started")
        environment = {**os.environ, "ROS_MASTER_URI": "http://10.88.0.1:11311", "ROS_IP": "10.88.0.1"}
        # The force that the controller needs comes from the other host.
        force = subprocess.run([*self.places["rig"].enter, "timeout", str(PATIENCE), "rostopic", "echo", "-n", "1",
                                "/cell/predicted_cf"], env=environment, capture_output=True, text=True)
        self.assertIn("force:", force.stdout, force.stderr)
        node = subprocess.run([*self.places["rig"].enter, "rosnode", "info", "/cell_simulator"], env=environment,
                              capture_output=True, text=True)
        self.assertIn("http://10.88.0.2:", node.stdout)


if __name__ == "__main__":
    unittest.main()
