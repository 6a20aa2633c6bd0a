"""``openravepy.convexdecompositionpy``: convex decomposition of meshes; ``ravemj convert`` uses it."""

from ravemj.compat.refusal import refusing

computeConvexDecomposition = refusing("computeConvexDecomposition", "convex parts for scripts", "*arguments **named")
