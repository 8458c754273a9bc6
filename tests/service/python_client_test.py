"""A client of plain generated code, in another language, works: python_client_test.py SERVER PROTO.

Streams two frames, an error inside the stream, and resumes. Needs python3-grpcio, python3-protobuf
and the compilers of protobuf; without them the test is skipped.
"""

import array
import importlib
import os
import queue
import shutil
import subprocess
import sys
import tempfile

from server_program import ServerProgram, skip

try:
    import google.protobuf  # noqa: F401
    import grpc
except ImportError as missing:
    skip(f"{missing}; packages python3-grpcio and python3-protobuf")

WIDTH, HEIGHT = 16, 12
CHANNELS = {"depth": 1, "normal": 3, "objectId": 1, "light0.unshadowed": 3, "light0.visibility": 1}
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
CLIP_FROM_VIEW = [1, 0, 0, 0, 0, 4 / 3, 0, 0, 0, 0, -1.002, -0.2002, 0, 0, -1, 0]


def generate(proto, folder):
    """The modules of the protocol, made by protoc."""
    plugin = shutil.which("grpc_python_plugin")
    if not shutil.which("protoc") or not plugin:
        skip("packages protobuf-compiler and protobuf-compiler-grpc are not installed")
    names = ["error", "scene", "denoise_service", "session_service"]
    subprocess.run(
        ["protoc", f"-I{proto}", f"--python_out={folder}", f"--grpc_python_out={folder}",
         f"--plugin=protoc-gen-grpc_python={plugin}", *[f"holdfast/v1/{n}.proto" for n in names]],
        check=True)
    sys.path.insert(0, folder)
    return [importlib.import_module(f"holdfast.v1.{n}") for n in
            ("denoise_service_pb2", "denoise_service_pb2_grpc", "session_service_pb2",
             "session_service_pb2_grpc", "scene_pb2")]


def plane_bytes(name, index):
    """A wall five metres away; visibility is a checkerboard that moves."""
    pixels = WIDTH * HEIGHT
    if name == "objectId":
        return array.array("I", [1] * pixels).tobytes()
    if name == "normal":
        return array.array("f", [0] * (2 * pixels) + [1] * pixels).tobytes()
    if name == "light0.visibility":
        return array.array("f", [(i + i // WIDTH + index) % 2 for i in range(pixels)]).tobytes()
    value = 5 if name == "depth" else 0.5
    return array.array("f", [value] * (pixels * CHANNELS[name])).tobytes()


class Stream:
    """One Denoise stream; messages are written and read in turn."""

    def __init__(self, stub, messages, session):
        self.messages = messages
        self.outgoing = queue.Queue()
        self.incoming = stub.Denoise(iter(self.outgoing.get, None), timeout=60)
        hello = messages.Hello(session_id=session.session_id, token=session.token)
        self.send(hello=hello)
        self.welcome = next(self.incoming).welcome

    def send(self, **message):
        self.outgoing.put(self.messages.DenoiseRequest(**message))

    def send_frame(self, index, cut_short=None):
        """Sends one frame; the plane named `cut_short` lacks its last bytes."""
        pb = self.messages
        begin = pb.FrameBegin(index=index)
        begin.camera.view_from_world.values.extend(IDENTITY)
        begin.camera.clip_from_view.values.extend(CLIP_FROM_VIEW)
        light = begin.lights.add(id=0)
        light.world_from_local.values.extend(IDENTITY)
        for number in range(len(CHANNELS)):
            begin.planes.add(plane=number, width_px=WIDTH, height_px=HEIGHT)
        self.send(frame_begin=begin)
        for number, name in enumerate(CHANNELS):
            data = plane_bytes(name, index)
            if name == cut_short:
                data = data[:-4]
            self.send(plane_chunk=pb.PlaneChunk(plane=number, offset=0, last=True, data=data))
        self.send(frame_end=pb.FrameEnd(index=index))

    def receive(self):
        """FrameResult, and the bytes of each plane that follows it."""
        result = next(self.incoming).frame_result
        planes = {plane.plane: b"" for plane in result.planes}
        for number in planes:
            last = False
            while not last:
                chunk = next(self.incoming).plane_chunk
                assert chunk.plane == number and chunk.offset == len(planes[number])
                planes[number] += chunk.data
                last = chunk.last
        return result, planes

    def finish(self):
        self.outgoing.put(None)
        assert list(self.incoming) == [], "nothing may follow"
        assert self.incoming.code() == grpc.StatusCode.OK


def check_answer(result, planes, session, index):
    assert not result.HasField("error"), result.error
    assert result.index == index and result.preset == "balanced"
    assert len(planes) == len(session.result_planes)
    for number, name in enumerate(session.result_planes):
        channels = 3 if name == "composite" else 1
        assert len(planes[number]) == 4 * channels * WIDTH * HEIGHT, name
    composite = array.array("f", planes[list(session.result_planes).index("composite")])
    assert all(0 <= value <= 1 for value in composite), "between the light and the shadow"
    assert 0.1 < sum(composite) / len(composite) < 0.4, "half of the light comes through"


def check(channel, modules):
    denoise, denoise_grpc, sessions, sessions_grpc, scene = modules
    unary = sessions_grpc.SessionServiceStub(channel)
    stub = denoise_grpc.DenoiseServiceStub(channel)
    assert "reliable" in unary.GetServerInfo(sessions.GetServerInfoRequest()).recipes
    session = unary.CreateSession(sessions.CreateSessionRequest(
        width_px=WIDTH, height_px=HEIGHT, planes=list(CHANNELS),
        lights=[scene.Light(id=0, shape=scene.LIGHT_SHAPE_RECTANGLE, width_m=1, height_m=1)]))

    stream = Stream(stub, denoise, session)
    assert not stream.welcome.resumed and stream.welcome.credits >= 1
    stream.send_frame(0)
    result, planes = stream.receive()
    check_answer(result, planes, session, 0)
    assert result.history_reset
    stream.send_frame(1, cut_short="light0.visibility")
    result, planes = stream.receive()
    assert result.error.violation.subject == "last of a chunk of plane light0.visibility", result
    assert not planes
    stream.send_frame(1)
    result, first = stream.receive()
    check_answer(result, first, session, 1)
    assert not result.history_reset, "the error cost no history"
    stream.finish()

    stream = Stream(stub, denoise, session)
    assert stream.welcome.resumed and stream.welcome.last_frame_index == 1
    stream.send_frame(1)
    result, again = stream.receive()
    assert result.repeated and again == first, "answered from memory, to the bit"
    stream.send_frame(2)
    result, planes = stream.receive()
    check_answer(result, planes, session, 2)
    assert not result.history_reset and result.mean_history_frames > 1
    stream.finish()
    unary.DeleteSession(sessions.DeleteSessionRequest(session_id=session.session_id,
                                                      token=session.token))


def main():
    server, proto = sys.argv[1:]
    os.environ["no_proxy"] = "127.0.0.1"
    with tempfile.TemporaryDirectory() as folder:
        modules = generate(proto, folder)
        with ServerProgram(server) as running:
            with grpc.insecure_channel(running.address) as channel:
                check(channel, modules)
    print("a generated client streams, is told of an error, and resumes")


if __name__ == "__main__":
    main()
