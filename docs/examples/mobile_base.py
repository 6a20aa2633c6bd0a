"""A cart drives between obstacles.

It has no joints that matter: what is planned are x, y and the angle of its base, three affine degrees of freedom.
"""

import numpy as np
from stage import GREEN, add_box, filmed, wait

import ravemj

CART = """<Environment><Robot name="cart"><KinBody><Body name="base">
  <Geom type="box"><Translation>0 0 0.12</Translation><Extents>0.32 0.14 0.06</Extents>
    <diffuseColor>0.9 0.7 0.15</diffuseColor></Geom>
  <Geom type="box"><Translation>0.22 0 0.24</Translation><Extents>0.05 0.1 0.06</Extents>
    <diffuseColor>0.2 0.25 0.3</diffuseColor></Geom>
  <Geom type="cylinder"><Translation>0.2 0 0.06</Translation><radius>0.06</radius><height>0.3</height>
    <diffuseColor>0.2 0.25 0.3</diffuseColor></Geom>
  <Geom type="cylinder"><Translation>-0.2 0 0.06</Translation><radius>0.06</radius><height>0.3</height>
    <diffuseColor>0.2 0.25 0.3</diffuseColor></Geom>
</Body></KinBody></Robot></Environment>"""


def main() -> None:
    """Drive from one corner of a room to the other, and turn round on the way."""
    env = ravemj.Environment()
    env.LoadData(CART)
    robot = env.GetRobots()[0]
    walls = [([-0.6, 0.5], 1.1), ([0.5, -0.5], 1.1)]  # each leaves a gap at one side
    for number, ((y, x), length) in enumerate(walls):
        add_box(env, f"wall {number}", [x, y, 0.2], [length, 0.05, 0.2], GREEN)
    for number, x in enumerate((-1.65, 1.65)):
        add_box(env, f"side {number}", [x, 0, 0.2], [0.05, 1.6, 0.2], GREEN)

    affine = ravemj.DOFAffine
    robot.SetController(ravemj.RaveCreateController(env, "IdealController"), [], affine.Transform)
    robot.SetAffineTranslationLimits([-1.6, -1.5, 0], [1.6, 1.5, 0])
    robot.SetAffineTranslationMaxVels([0.8, 0.8, 0.8])
    robot.SetAffineRotationAxisMaxVels([1.5, 1.5, 1.5, 1.5])
    robot.SetTransform([1, 0, 0, 0, -1.0, -1.1, 0])
    robot.SetActiveDOFs([], affine.X | affine.Y | affine.RotationAxis, [0, 0, 1])
    planner = ravemj.interfaces.BaseManipulation(robot)
    with filmed(env, [0, 0, 0], [0.5, -2.4, 3.6]):
        planner.MoveActiveJoints(goal=[1.0, 1.1, np.pi], postprocessingplanner="LinearSmoother")
        wait(robot)
    print("the cart is at", robot.GetActiveDOFValues().round(2))


if __name__ == "__main__":
    main()
