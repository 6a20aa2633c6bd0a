"""Files of OpenRAVE's databases: tables as ``.npz`` with a JSON header, and old pickles."""
