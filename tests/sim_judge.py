"""Whether an MJCF file can be simulated, as numbers: measured with plain MuJoCo, from the file and Pinocchio's numbers.

``python tests/sim_judge.py FILE.xml …`` prints the numbers of files; ``judge`` returns them.
"""

import json
import sys

import mujoco
import numpy as np

HOLD, STEP, WATCHED = 2.0, {False: 0.1, True: 0.01}, 0.5
ANGLE, SLIDE = 0.01, 0.001


def opened(path, *, free_floor=False):
    """Return a model and its data at the start pose; with a floor under it if that is wanted."""
    spec = mujoco.MjSpec.from_file(str(path))
    model = spec.compile()
    data = started(model)
    if free_floor:
        low = lowest(model, data)
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], pos=[0, 0, low], name="judge/floor")
        model = spec.compile()
        data = started(model)
    return model, data


def started(model):
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    data.ctrl[:] = targets(model, data)
    mujoco.mj_forward(model, data)
    return data


def targets(model, data):
    qpos = [int(model.jnt_qposadr[model.actuator_trnid[one, 0]]) for one in range(model.nu)]
    return data.qpos[qpos]


def corners(model, geom):
    """Return points of a geom in its frame whose box is that of the geom, turned as it is."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        return model.mesh_vert[first : first + count].astype(float)
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return np.array(np.meshgrid(*[(-one, one) for one in size])).reshape(3, -1).T
    return None


def box(model, geom, position, rotation):
    points = corners(model, geom)
    if points is not None:
        moved = points @ rotation.T + position
        return moved.min(axis=0), moved.max(axis=0)
    kind, (radius, half, _) = model.geom_type[geom], model.geom_size[geom]
    reach = np.full(3, radius)
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        reach = radius * np.sqrt(np.maximum(0, 1 - rotation[:, 2] ** 2)) + half * np.abs(rotation[:, 2])
    elif kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        reach = radius + half * np.abs(rotation[:, 2])
    return position - reach, position + reach


def lowest(model, data):
    lows = [
        box(model, geom, data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3))[0][2]
        for geom in range(model.ngeom)
        if collides(model, geom) and model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_PLANE
    ]
    return min(lows, default=0.0)


def collides(model, geom):
    return bool(model.geom_contype[geom] or model.geom_conaffinity[geom])


def touching(model, data):
    return sorted(
        {tuple(sorted(model.body(model.geom_bodyid[geom]).name for geom in contact.geom)) for contact in data.contact}
    )


def switched_off(model):
    """Whether solid links of the model can never touch one another by their masks."""
    solid = [geom for geom in range(model.ngeom) if collides(model, geom)]
    return len(solid) > 1 and not any(
        model.geom_contype[a] & model.geom_conaffinity[b] for a in solid for b in solid if a != b
    )


def energy(model, data):
    mujoco.mj_kinematics(model, data)  # a step ends before that
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeM(model, data)
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    return data.energy[0], data.energy[1]


def passive(path):
    """Return whether warnings came up in 2 s without actuation, and how much energy came from nowhere."""
    model, data = opened(path)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    first, kinetic, most = sum(energy(model, data)), 0.0, 0.0
    for _ in range(round(HOLD / model.opt.timestep)):
        mujoco.mj_step(model, data)
        potential, moving = energy(model, data)
        most, kinetic = max(most, potential + moving - first), max(kinetic, moving)
    return warnings_of(data), most / kinetic if kinetic > 1e-9 else 0.0


def warnings_of(data):
    return sum(int(warning.number) for warning in data.warning)


def hold(path, *, on_floor=False):
    """Return the droop of all joints after 2 s as parts of what is allowed, with names; and how far the base sank."""
    model, data = opened(path, free_floor=on_floor)
    aim, base = targets(model, data), data.qpos[2] if model.nq and model.jnt_type[0] == 0 else 0.0
    for _ in range(round(HOLD / model.opt.timestep)):
        mujoco.mj_step(model, data)
    found = {}
    for one, error in enumerate(np.abs(targets(model, data) - aim)):
        slides = model.jnt_type[model.actuator_trnid[one, 0]] == mujoco.mjtJoint.mjJNT_SLIDE
        found[model.actuator(one).name] = float(error) / (SLIDE if slides else ANGLE)
    sank = base - data.qpos[2] if model.nq and model.jnt_type[0] == 0 else 0.0
    return model, data, found, warnings_of(data), float(sank)


def steps(model, data):
    """Return overshoot and rise time of a step of each joint alone, from where it holds."""
    state = data.qpos.copy(), data.qvel.copy(), data.ctrl.copy(), data.act.copy()
    found = {}
    for one in range(model.nu):
        joint = model.actuator_trnid[one, 0]
        place, slides = model.jnt_qposadr[joint], model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:], data.ctrl[:], data.act[:] = state
        mujoco.mj_forward(model, data)
        before, size = data.qpos[place], STEP[bool(slides)]
        if model.jnt_limited[joint]:
            lower, upper = model.jnt_range[joint]
            if before - lower > upper - before:
                size = -size
            if upper - lower < 2 * abs(size):
                continue
        data.ctrl[one] += size
        over, rise = 0.0, np.inf
        for number in range(round(WATCHED / model.opt.timestep)):
            mujoco.mj_step(model, data)
            part = (data.qpos[place] - before) / size
            over = max(over, part - 1)
            if part >= 0.9 and rise == np.inf:
                rise = (number + 1) * model.opt.timestep
        found[model.actuator(one).name] = (over, rise)
    return found


def against(path, truth):
    """Return the largest differences from Pinocchio's numbers."""
    model, data = opened(path)
    followers = sum(bool(joint["mimic"]) and joint["type"] != "fixed" for joint in truth["joints"].values())
    apart = all(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) < 0 for name in truth["links"])
    links = truth["links"] if apart else {}  # where links are merged, so are tensors and boxes
    return {
        "missing": [name for name in truth["links"] if name != "world" and not has(model, name)],
        "pose": max(pose_error(model, data, truth, config) for config in truth["configs"]),
        "mass": abs(model.body_mass.sum() - truth["total"]),
        "tensor": max([tensor_error(model, name, link) for name, link in links.items()], default=0.0),
        "mimic": f"{model.neq}/{followers}",
        "boxes": boxes_off(model, truth) if apart else [],
        **limit_errors(model, truth["joints"]),
    }


def pose_error(model, data, truth, config):
    values = dict(config["values"])
    for name, joint in truth["joints"].items():
        if joint["mimic"] and joint["mimic"][0] in values:
            leader, factor, offset = joint["mimic"]
            values[name] = factor * values[leader] + offset
    for name, value in values.items():
        if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) >= 0:
            data.joint(name).qpos[:] = value
    mujoco.mj_kinematics(model, data)
    poses = {name: np.array(pose).reshape(3, 4) for name, pose in config["poses"].items()}
    root = next(name for name, pose in poses.items() if np.allclose(pose, np.eye(4)[:3]))
    rotation, position = frame(model, data, root)
    errors = [0.0]
    for name, pose in poses.items():
        if has(model, name):
            own, place = frame(model, data, name)
            errors += [np.abs(rotation.T @ own - pose[:, :3]).max()]
            errors += [np.abs(rotation.T @ (place - position) - pose[:, 3]).max()]
    return max(errors)


def limit_errors(model, joints):
    found = {"limit": 0.0, "effort": 0.0}
    for name, joint in joints.items():
        number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        if joint["type"] == "fixed" or number < 0:
            continue
        limits = joint["lower"], joint["upper"]
        if joint["type"] != "continuous" and limits[0] < limits[1] and not joint["mimic"]:
            found["limit"] = max(found["limit"], np.abs(model.jnt_range[number] - limits).max())
        if joint["effort"]:
            found["effort"] = max(found["effort"], abs(model.jnt_actfrcrange[number][1] - joint["effort"]))
    return found


def tensor_error(model, name, link):
    """Return how far the tensor of a link is from the file's, relative to its largest number; 0 if that is illegal."""
    tensor = np.array(link.get("inertia", np.zeros(9))).reshape(3, 3)
    moments = np.linalg.eigvalsh(tensor)
    if not (link["mass"] > 0 and moments[0] > 0 and moments[0] + moments[1] >= moments[2] and has(model, name)):
        return 0.0
    body, turned = model.body(name), np.zeros(9)
    mujoco.mju_quat2Mat(turned, body.iquat)
    turned = turned.reshape(3, 3)
    return np.abs(turned @ np.diag(body.inertia) @ turned.T - tensor).max() / np.abs(tensor).max()


def boxes_off(model, truth):
    """Return the links whose box of visual or of collision shapes is off by more than 1 % of its diagonal."""
    off = []
    for name, kinds in truth["boxes"].items():
        if not has(model, name):
            continue
        body = model.body(name).id
        for kind, boxes in kinds.items():
            wanted = np.array(boxes).reshape(-1, 6)
            own = [geom for geom in range(model.ngeom) if model.geom_bodyid[geom] == body]
            own = [geom for geom in own if collides(model, geom) == (kind == "collision")]
            if not len(wanted) or not own:
                if len(wanted) != len(own):
                    off.append((name, kind, f"{len(own)} of {len(wanted)}"))
                continue
            low, high = wanted[:, :3].min(axis=0), wanted[:, 3:].max(axis=0)
            parts = []
            for geom in own:
                turned = np.zeros(9)
                mujoco.mju_quat2Mat(turned, model.geom_quat[geom])
                parts.append(box(model, geom, model.geom_pos[geom], turned.reshape(3, 3)))
            found = np.min([one[0] for one in parts], axis=0), np.max([one[1] for one in parts], axis=0)
            error = max(np.abs(found[0] - low).max(), np.abs(found[1] - high).max())
            if error > 0.01 * np.linalg.norm(high - low):
                off.append((name, kind, round(float(error), 4)))
    return off


def has(model, name):
    kinds = mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtObj.mjOBJ_SITE
    return any(mujoco.mj_name2id(model, kind, name) >= 0 for kind in kinds)


def frame(model, data, name):
    if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) >= 0:
        body = data.body(name)
        return body.xmat.reshape(3, 3), body.xpos
    site = data.site(name)
    return site.xmat.reshape(3, 3), site.xpos


def judge(path, *, truth=None, with_steps=True):
    """Return the numbers of a file."""
    model, data = opened(path)
    found = {"touching": touching(model, data), "self_collision_off": switched_off(model), "nu": model.nu}
    if truth is not None:
        found |= against(path, truth)
    found["passive_warnings"], found["energy"] = passive(path)
    if model.nu:
        model, data, droop, warned, _ = hold(path)
        found["hold_warnings"] = warned
        worst = max(droop, key=droop.get)
        found["droop"], found["droop_joint"] = droop[worst], worst
        found["drooping"] = {name: round(part, 2) for name, part in droop.items() if not part <= 1}
        if with_steps:
            moved = steps(model, data)
            found["overshoot"] = max((over for over, _ in moved.values()), default=0.0)
            found["rise"] = max((rise for _, rise in moved.values()), default=0.0)
            found["bad_steps"] = {
                name: (round(float(over), 3), rise)
                for name, (over, rise) in moved.items()
                if not (over < 0.1 and rise <= 0.5)
            }
    return found


def standing(path):
    """Return the droop and how far a free base sinks in 2 s on a floor."""
    _, _, droop, warned, sank = hold(path, on_floor=True)
    return {"droop": max(droop.values(), default=0.0), "sank": sank, "warnings": warned}


if __name__ == "__main__":
    for file in sys.argv[1:]:
        print(file, json.dumps(judge(file), default=str))
