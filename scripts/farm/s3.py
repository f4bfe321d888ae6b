"""Parts of scripts/farm/s3.sh that speak to a server of objects, or pretend to be one.

    s3.py port                 prints a port that is free
    s3.py mute PORT            accepts connections and never answers
    s3.py make BUCKET          makes a bucket
    s3.py list BUCKET PREFIX   prints the names of all objects
    s3.py lie BUCKET PREFIX    exchanges two objects, damages a byte of a third, cuts a fourth short and empties a fifth

The server and the credentials are those of the variables that luthier reads, too.
"""

import os
import socket
import sys
import time


def server():
    import boto3

    return boto3.client("s3", endpoint_url=os.environ["AWS_ENDPOINT_URL"], region_name="us-east-1")


def names(bucket, prefix):
    pages = server().get_paginator("list_objects_v2").paginate(Bucket=bucket, Prefix=prefix)
    return sorted(entry["Key"] for page in pages for entry in page.get("Contents", []))


def lie(bucket, prefix):
    s3 = server()
    first = names(bucket, prefix)[:5]
    one, two, three, four, five = [s3.get_object(Bucket=bucket, Key=name)["Body"].read() for name in first]
    damaged = bytearray(three)
    damaged[-1] ^= 1
    for name, body in zip(first, [two, one, bytes(damaged), four[:-1], b""]):
        s3.put_object(Bucket=bucket, Key=name, Body=body)


def mute(port):
    listener = socket.create_server(("127.0.0.1", port), backlog=256)
    kept = []
    while True:
        kept.append(listener.accept())


def port():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return listener.getsockname()[1]


match sys.argv[1:]:
    case ["port"]:
        print(port())
    case ["mute", number]:
        mute(int(number))
    case ["make", bucket]:
        # The server may still be starting.
        for attempt in range(100):
            try:
                server().create_bucket(Bucket=bucket)
                break
            except Exception:
                if attempt == 99:
                    raise
                time.sleep(0.2)
    case ["list", bucket, prefix]:
        print("\n".join(names(bucket, prefix)))
    case ["lie", bucket, prefix]:
        lie(bucket, prefix)
    case _:
        sys.exit(__doc__)
