# SPDX-License-Identifier: MIT
"""A PyOpenCL kernel that reads clpv's volumes: indirect light on a plane of points, without a copy
through the host.

    python3 examples/lookup.py [scenes/cornell.json]
"""
import sys

import numpy as np
import pyopencl as cl

import clpv

KERNEL = """
__kernel void light_plane(const float height, const float size, __global float4* light, CLPV_RADIANCE) {
  const uint x = get_global_id(0), z = get_global_id(1), n = get_global_size(0);
  const float3 position = (float3)(size * (x + 0.5f) / n, height, size * (z + 0.5f) / n);
  light[z * n + x] = clpv_irradiance(CLPV_PASS_RADIANCE, position, (float3)(0.0f, -1.0f, 0.0f));
}
"""


def memory(argument):
    """Memory that clpv returned, as pyopencl has it; numbers as they are."""
    if not isinstance(argument, int):
        return argument
    return cl.MemoryObject.from_int_ptr(argument, retain=True)


def main(path="scenes/cornell.json"):
    scene = clpv.Scene(path)
    context = cl.create_some_context(interactive=False)
    queue = cl.CommandQueue(context)
    renderer = clpv.Renderer(scene, context=context, queue=queue, width=160, height=90, basis="sh2")
    frame = renderer.enqueue("full")

    # The kernel runs in the same queue, after the frame, and sees its volumes.
    program = cl.Program(context, renderer.lookup_source() + KERNEL).build("-cl-std=CL1.2")
    n, height, size = 32, 0.4, 0.55
    light = cl.Buffer(context, cl.mem_flags.WRITE_ONLY, 16 * n * n)
    program.light_plane(queue, (n, n), None, np.float32(height), np.float32(size), light,
                        *map(memory, renderer.device_volumes().arguments()))
    looked_up = np.empty((n, n, 4), np.float32)
    cl.enqueue_copy(queue, looked_up, light)

    # The frame's own image, on the device too.
    image = np.empty((frame.height, frame.width, 4), np.float32)
    cl.enqueue_copy(queue, image, memory(frame.image))
    print(
        f"image: mean {image[..., :3].mean():.4f}; light on the plane: {looked_up[..., :3].mean(axis=(0, 1))} W/m^2"
    )

    z, x = (np.mgrid[:n, :n] + 0.5) * size / n
    points = np.stack([x, np.full_like(x, height), z], axis=-1)
    expected = renderer.irradiance(points, np.broadcast_to([0, -1, 0], points.shape))
    assert np.allclose(looked_up[..., :3], expected, rtol=1e-3, atol=1e-5)


if __name__ == "__main__":
    main(*sys.argv[1:])
