#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Prints every alert that comes in a session that stays: keeper.py PORT 3.1.1|5

A message is acknowledged after it was printed, so that a killed keeper has lost none.
"""
import sys

import paho.mqtt.client as mqtt
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties

port, version = int(sys.argv[1]), sys.argv[2]
TOPIC = "kidnapwatch/v1/+/alert"


def connected(client, _userdata, _flags, _reason, _properties=None):
    client.subscribe(TOPIC, qos=1)


if version == "5":
    session = Properties(PacketTypes.CONNECT)
    session.SessionExpiryInterval = 3600
    client = mqtt.Client(client_id="keeper-5", protocol=mqtt.MQTTv5)
    client.connect_async("127.0.0.1", port, clean_start=False, properties=session)
else:
    client = mqtt.Client(client_id="keeper-3", protocol=mqtt.MQTTv311, clean_session=False)
    client.connect_async("127.0.0.1", port)
client.on_connect = connected
client.on_subscribe = lambda *_: print("listening", flush=True)
client.on_message = lambda _client, _data, message: print(message.payload.decode(), flush=True)
client.loop_forever(retry_first_connection=True)
