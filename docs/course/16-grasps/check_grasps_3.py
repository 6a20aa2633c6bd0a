"""Check of grasps-3."""

from ravemj.learn import Check

GRAVITY = 9.81


def question(random):
    return random.uniform(0.05, 2), random.uniform(0.1, 1.2), random.uniform(-15, 10)


def answer(mass, friction, acceleration):
    return abs(mass * (GRAVITY + acceleration)) / (2 * friction)


CHECK = Check(
    function="least_force",
    question=question,
    answer=answer,
    kind="number",
    mistakes={
        "One finger carries all of it: each of the two carries half.": lambda m, mu, a: 2 * answer(m, mu, a),
        "The acceleration is forgotten: gravity alone acts on an object at rest only.": lambda m, mu, a: answer(
            m, mu, 0
        ),
        "The acceleration has the wrong sign: lifting faster needs more force.": lambda m, mu, a: answer(m, mu, -a),
        "Gravity is forgotten: the object has a weight, too.": lambda m, mu, a: answer(m, mu, a - GRAVITY),
        "The friction coefficient is multiplied: a slippery object needs more force.": lambda m, mu, a: (
            answer(m, 1, a) * mu
        ),
        "The friction coefficient is forgotten: friction is at most mu times a finger's force.": lambda m, mu, a: (
            answer(m, 1, a)
        ),
        "If the hand goes down faster than it would fall, it has to pull the object down: the force is not 0.": (
            lambda m, mu, a: answer(m, mu, max(a, -GRAVITY))
        ),
        "The force is negative if the hand goes down faster than in free fall: fingers cannot pull.": lambda m, mu, a: (
            m * (GRAVITY + a) / (2 * mu)
        ),
    },
    hints=(
        "Which force, along the fingers' surfaces, does the object need to move with the hand?",
        "It needs mass * (9.81 + acceleration), up or down. Each finger gives at most friction times its force.",
        "abs(mass * (9.81 + acceleration)) / (2 * friction)",
    ),
)
