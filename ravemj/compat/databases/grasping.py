"""Grasps of a body by a hand."""

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.compat.databases.visibility import GripperVisibility
from ravemj.compat.refusal import lacking, refusing

GRASPS = "planning of grasps"


@lacking(
    GRASPS,
    """
    ComputeCircleApproachRays(center normalaxis delta normalanglerange directiondelta)
    GetLocalGraspTransform(grasp collisionfree) autogenerateparams(options)
    computeBoxApproachRays(delta normalanglerange directiondelta)
    computePlaneApproachRays(center sidex sidey delta normalanglerange directiondelta)
    computeSphereApproachRays(delta normalanglerange directiondelta)
    computeValidGrasps(startindex checkcollision checkik checkgrasper backupdist returnnum)
    drawContacts(contacts conelength transparency)
    generatepcg(preshapes standoffs rolls approachrays graspingnoise forceclosure forceclosurethreshold
        checkgraspfn manipulatordirections translationstepmult finestep friction avoidlinks plannername boxdelta
        spheredelta normalanglerange)
    getGlobalApproachDir(grasp) getGlobalGraspTransform(grasp collisionfree) getPreshape(grasp)
    init(friction avoidlinks plannername) moveToPreshape(grasp execute outputtraj outputtrajobj)
    runGrasp(grasp graspingnoise translate forceclosure translationstepmult finestep)
    runGraspFromTrans(grasp finestep) setFinalFingerValues(grasp) setPreshape(grasp)
    show(delay options forceclosure showcontacts) showgrasp(grasp collisionfree useik delay showfinal)
    testGrasp(graspingnoise Ngraspingtries forceclosurethreshold **named)
    validGraspIterator(startindex checkcollision checkik checkgrasper backupdist randomgrasps returnfinal)
    @CreateOptionParser() @InitializeFromParser(Model parser defaultviewer args *margs **named)
    """,
)
class GraspingModel(DatabaseGenerator):
    """Grasps of a body by a hand."""

    capability = GRASPS
    GripperVisibility = GripperVisibility
    graspsetname = ""

    def load(self, filename: str | None = None) -> bool:
        """Return whether there is something to use: False."""
        del filename
        return False


run = refusing("grasping.run", GRASPS, "*arguments **named")
