"""body-3: Can the biped reach a point and keep its feet?

`start` has the pose of the biped's pelvis, [qw, qx, qy, qz, x, y, z], and then its 25 joint values. Put the biped
there. Then let its manipulator `left_hand` reach `point`, in the world [m], while `left_foot` and `right_foot` stay
where they are, and so do x and y of its centre of mass. Return the pose of the pelvis and the joint values that it has
then, in the same form. Nothing should be off by more than 1 mm, or by 0.001 rad.

The robot may be asked, and moved by `ravemj.WholeBodyIK`. `robot.SetTransform` takes the seven numbers of a pose,
`ravemj.poseFromMatrix(robot.GetTransform())` returns them.
"""

import numpy as np

import ravemj


def reach(robot, start, point):
    """Return the pose of the pelvis and the joint values, shape (32,)."""
    robot.SetTransform(start[:7])
    robot.SetDOFValues(start[7:])
    ik = ravemj.WholeBodyIK(robot, base=True)
    ik.add_contact("left_foot")
    ik.add_contact("right_foot")
    ik.add_com(axes="xy")
    ik.add_reach("left_hand", point)
    ik.add_posture()
    ik.solve()
    return np.concatenate([ravemj.poseFromMatrix(robot.GetTransform()), robot.GetDOFValues()])
