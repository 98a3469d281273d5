#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A robot's controller: stops when the robot was kidnapped, and says when it knows its place again.

    controller.py --robot r1 --host BROKER --port 8883 \\
      --ca operators-ca.crt --cert r1.crt --key r1.key

Hears the robot's own alerts and state in a session that stays, so that nothing said while it is
away is missed; an alert that comes twice (at least once, says QoS 1) counts once. A line on
standard input, which stands for the robot's own localization, has it send `relocalized`; the answer
is printed. `quit` ends it.

Without --cert it connects in the clear. Needs python3-paho-mqtt (1.6, as in Debian 12).
"""
import argparse
import json
import sys
import threading
import uuid

import paho.mqtt.client as mqtt
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties


class Controller:
    """What the robot does about what is told of it."""

    def __init__(self, robot, prefix):
        self.robot = robot
        self.topic = f"{prefix}/{robot}"
        self.seen = {}  # by incident: the highest seq
        self.stopped = False
        self.awaited = {}  # commands by their correlation data
        self.client = mqtt.Client(client_id=robot, protocol=mqtt.MQTTv5)
        self.client.on_connect = self.on_connect
        self.client.on_subscribe = lambda *_: say("listening")
        self.client.message_callback_add(f"{self.topic}/alert", self.on_alert)
        self.client.message_callback_add(f"{self.topic}/state", self.on_state)
        self.client.message_callback_add(f"{self.topic}/response", self.on_answer)

    def run(self, host, port):
        session = Properties(PacketTypes.CONNECT)
        session.SessionExpiryInterval = 24 * 3600
        self.client.connect(host, port, keepalive=15, clean_start=False, properties=session)
        threading.Thread(target=self.read_localization, daemon=True).start()
        self.client.loop_forever(retry_first_connection=True)

    def on_connect(self, client, _userdata, _flags, reason, _properties=None):
        if reason != 0:
            say(f"not connected: {reason}")
            return
        client.subscribe([(f"{self.topic}/{kind}", mqtt.SubscribeOptions(qos=1))
                          for kind in ("alert", "state", "response")])

    def on_alert(self, _client, _userdata, message):
        alert = json.loads(message.payload)
        if alert["seq"] <= self.seen.get(alert["incidentId"], 0):
            return  # the same eventId again, or what happened before it
        self.seen[alert["incidentId"]] = alert["seq"]
        say(f"alert {alert['type']} {alert['incidentId']} seq {alert['seq']}")
        if alert["state"] == "resolved":
            self.go(f"resolved by {alert.get('resolvedBy', 'rule')}")
        else:
            self.stop(alert["explanation"])

    def stop(self, why):
        if not self.stopped:
            # The robot's own way to stand still belongs here: a Twist of zeros, a safety stop, ...
            self.stopped = True
            say(f"STOP: {why}")

    def go(self, why):
        if self.stopped:
            self.stopped = False
            say(f"GO: {why}")

    def on_state(self, _client, _userdata, message):
        state = json.loads(message.payload)
        say(f"state {state['state']}" + (f": {state['explanation']}" if "trouble" in state else ""))
        if state["state"] == "kidnapped":  # retained: known even to a controller new to all this
            self.stop("an incident is open")

    def read_localization(self):
        for line in sys.stdin:
            if line.strip() == "quit":
                break
            self.relocalized()
        self.client.disconnect()

    def relocalized(self):
        call = uuid.uuid4().bytes
        self.awaited[call] = "relocalized"
        properties = Properties(PacketTypes.PUBLISH)
        properties.ResponseTopic = f"{self.topic}/response"
        properties.CorrelationData = call
        properties.ContentType = "application/json"
        properties.MessageExpiryInterval = 10  # nobody wants it carried out later
        self.client.publish(f"{self.topic}/command", json.dumps({"command": "relocalized"}), qos=1,
                            properties=properties)

    def on_answer(self, _client, _userdata, message):
        command = self.awaited.pop(getattr(message.properties, "CorrelationData", None), None)
        if command is None:
            return  # an answer to somebody else
        answer = json.loads(message.payload)
        say(f"{command}: {answer['result']} {answer.get('detail', '')}".rstrip())


def say(text):
    print(text, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--robot", required=True)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=1883)
    parser.add_argument("--prefix", default="kidnapwatch/v1")
    for name in ("ca", "cert", "key"):
        parser.add_argument(f"--{name}")
    options = parser.parse_args()
    controller = Controller(options.robot, options.prefix)
    if options.cert:
        controller.client.tls_set(options.ca, options.cert, options.key)
    controller.run(options.host, options.port)


if __name__ == "__main__":
    main()
